// Numbers and lines in messages.
#pragma once

#include <algorithm>
#include <fmt/format.h>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

// "1 entity", "2 entities"; without `many` an s is added.
inline std::string counted(std::size_t number, const std::string& one, const std::string& many = {})
{
    return fmt::format("{} {}", number, number == 1 ? one : many.empty() ? one + "s" : many);
}

// Without their line feeds. A message of several problems has a line for each.
inline std::vector<std::string_view> linesOf(std::string_view text)
{
    std::vector<std::string_view> lines;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        lines.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return lines;
}

} // namespace penumbra
