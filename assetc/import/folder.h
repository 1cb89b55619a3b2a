// Confines the files that an input names (buffers, material libraries) to the input's own folder.
#pragma once

#include "runtime/result.h"

#include <filesystem>
#include <string>

namespace penumbra {

// The file that `name` means beside an input in `folder`. Refused: absolute paths, "..", other
// schemes (http:), and links that lead out of the folder. The file exists.
Result<std::filesystem::path> resolveInFolder(const std::filesystem::path& folder,
                                              const std::string& name);

// "a%20b" -> "a b".
std::string decodeUri(const std::string& uri);

} // namespace penumbra
