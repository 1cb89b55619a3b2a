// Dependencies for make, ninja and CMake (DEPFILE): "output: file file …".
#pragma once

#include "runtime/result.h"

#include <filesystem>
#include <vector>

namespace penumbra {

inline constexpr const char* kDepfileEnding = ".d"; // behind the name of the output

// Names as make reads them: a blank, '#' and ':' with a backslash before it, "$$" for a dollar.
// Error: a name with a line feed, which no depfile can hold.
Result<std::string> depfileText(const std::filesystem::path& output,
                                const std::vector<std::filesystem::path>& files);

} // namespace penumbra
