// SPIR-V by name. cmake/PenumbraShaders.cmake compiles, checks and embeds it; programs find it here
// without any file at run time.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

// Words of the shader whose source file is `name`, e.g. "combine.comp". An unknown name is a bug:
// the assert lists the known ones.
[[nodiscard]] std::span<const std::uint32_t> shaderCode(std::string_view name);

[[nodiscard]] std::vector<std::string> shaderNames(); // sorted

// For generated code only.
struct EmbeddedShader {
    const char* name;
    const std::uint32_t* begin;
    const std::uint32_t* end;
};
bool registerShaders(std::span<const EmbeddedShader> shaders);

} // namespace penumbra
