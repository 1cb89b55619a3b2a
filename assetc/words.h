// Numbers in messages.
#pragma once

#include <fmt/format.h>
#include <string>

namespace penumbra {

// "1 entity", "2 entities"; without `many` an s is added.
inline std::string counted(std::size_t number, const std::string& one, const std::string& many = {})
{
    return fmt::format("{} {}", number, number == 1 ? one : many.empty() ? one + "s" : many);
}

} // namespace penumbra
