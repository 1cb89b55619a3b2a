// The ways to combine shadow fields, all kept for comparison.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace penumbra {

enum class Kernel : std::uint32_t {
    Literal, // as the papers write it: trilinear, dense rotation, triple product
    Exact,   // nodal product and tetrahedral sampling
};

std::string_view kernelName(Kernel kernel); // "literal"
std::optional<Kernel> kernelFromName(std::string_view name);

} // namespace penumbra
