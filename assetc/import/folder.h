// Confines the files that an input names (buffers, material libraries) to the input's own folder.
#pragma once

#include "runtime/result.h"

#include <filesystem>
#include <string>
#include <vector>

namespace penumbra {

// A file that an input asked for, read or not: what the compiled bytes depend on.
struct AskedFile {
    std::string name; // beside the input
    bool found;
};

// The file that `name` means beside an input in `folder`. Refused: absolute paths, "..", other
// schemes (http:), and links that lead out of the folder. The file exists. `asked`, if any, gets
// the file appended unless its name is refused.
Result<std::filesystem::path> resolveInFolder(const std::filesystem::path& folder,
                                              const std::string& name,
                                              std::vector<AskedFile>* asked = nullptr);

// "a%20b" -> "a b".
std::string decodeUri(const std::string& uri);

} // namespace penumbra
