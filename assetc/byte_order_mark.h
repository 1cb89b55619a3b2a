// The mark that editors on Windows put before UTF-8: no part of the text.
#pragma once

#include <string_view>

namespace penumbra {

inline std::string_view withoutByteOrderMark(std::string_view text)
{
    constexpr std::string_view kMark = "\xef\xbb\xbf";
    return text.starts_with(kMark) ? text.substr(kMark.size()) : text;
}

} // namespace penumbra
