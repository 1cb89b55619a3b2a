#include "assetc/import/folder.h"

#include <algorithm>
#include <charconv>

namespace penumbra {

namespace fs = std::filesystem;

Result<fs::path> resolveInFolder(const fs::path& folder, const std::string& name,
                                 std::vector<AskedFile>* asked)
{
    const fs::path relative(name);
    const bool climbs =
        std::any_of(relative.begin(), relative.end(), [](const fs::path& p) { return p == ".."; });
    if (name.empty() || name.find('\0') != std::string::npos || relative.is_absolute() || climbs ||
        name.find_first_of(":\\") != std::string::npos)
        return Error{fmt::format(
            "\"{}\" is not a plain path below the input's folder; put the file beside the input",
            name)};
    std::error_code error;
    const fs::path root = fs::canonical(folder.empty() ? fs::path(".") : folder, error);
    const fs::path file = error ? fs::path() : fs::canonical(root / relative, error);
    if (asked)
        asked->push_back({relative.lexically_normal().string(), !error});
    if (error)
        return Error{fmt::format("\"{}\": {}", name, error.message())};
    if (std::mismatch(root.begin(), root.end(), file.begin(), file.end()).first != root.end())
        return Error{fmt::format("\"{}\" is a link that leads out of the input's folder", name)};
    return file;
}

std::string decodeUri(const std::string& uri)
{
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        unsigned code = 0;
        if (uri[i] == '%' && i + 2 < uri.size() &&
            std::from_chars(&uri[i + 1], &uri[i + 1] + 2, code, 16).ptr == &uri[i + 1] + 2) {
            text += static_cast<char>(code);
            i += 2;
        } else {
            text += uri[i];
        }
    }
    return text;
}

} // namespace penumbra
