// Where commands write, checked and done. Each says on stderr why it returns false.
#pragma once

#include "assetc/import/folder.h"

#include <cstddef>
#include <span>

namespace penumbra {

// `output` ends in `extension` and is not the input itself. False: wrong usage.
bool checkOutput(const std::filesystem::path& input, const std::filesystem::path& output,
                 const char* extension);

// No report is asked for, or one that ends in .json and is none of `others`. False: wrong usage.
bool checkReport(const std::filesystem::path& report,
                 const std::vector<std::filesystem::path>& others);

// No output or report replaces a file that the input names (assetc/overwrite.h). False: wrong
// usage.
bool checkOverwrite(const std::filesystem::path& input, const std::vector<AskedFile>& asked,
                    const std::vector<std::filesystem::path>& outputs);

bool writeOutput(const std::filesystem::path& file, std::span<const std::byte> bytes);
// Nothing where `file` is empty: no report is asked for.
bool writeReport(const std::filesystem::path& file, const std::string& text);

} // namespace penumbra
