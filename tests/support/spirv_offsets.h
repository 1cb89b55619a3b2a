// Reads struct layouts out of SPIR-V, to compare with offsetof and sizeof of the C++ twin:
//   const SpirvStruct gpu = spirvStruct(shaderCode("combine.comp"), "Receiver");
//   EXPECT_EQ(gpu.offset("normal"), offsetof(Receiver, normal));
//   EXPECT_EQ(gpu.arrayStride, sizeof(Receiver));
// Names are there because PenumbraShaders.cmake compiles with -g.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

struct SpirvMember {
    std::string name;
    std::uint32_t offset = 0; // bytes
};

struct SpirvStruct {
    std::vector<SpirvMember> members; // in order; empty: no struct of that name has a layout
    std::uint32_t arrayStride = 0;    // bytes from element to element; 0: never in an array

    // Of the member, or no value: then the test's comparison with a number fails.
    [[nodiscard]] std::optional<std::uint32_t> offset(std::string_view member) const;
};

// The struct or block type `name`. Of several (one per memory layout) the first that has offsets.
[[nodiscard]] SpirvStruct spirvStruct(std::span<const std::uint32_t> code, std::string_view name);

// Names of all structs and blocks with a layout, sorted, each once.
[[nodiscard]] std::vector<std::string> spirvStructNames(std::span<const std::uint32_t> code);

} // namespace penumbra
