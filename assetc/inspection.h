// What is in a file, of any kind that assetc knows.
#pragma once

#include "assetc/file_type.h"
#include "runtime/canvas.h"
#include "runtime/result.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace penumbra {

struct Inspection {
    FileType type = FileType::Other;
    std::string what;            // the file is, empty where it cannot be read
    std::string text, json;      // about a valid file, for people and for programs
    std::vector<Error> problems; // without the file's name; none: valid
    std::optional<Canvas> sheet; // of a valid asset, where one was asked for
    std::string sheetText;       // what is on it
};

// Told by its content, not its name. A source is valid if its compiler would read it to the end.
Inspection inspectFile(const std::filesystem::path& path, bool sheet);

} // namespace penumbra
