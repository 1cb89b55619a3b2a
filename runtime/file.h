// Whole files in and out. Reading is bounded; writing never leaves a half-written file behind.
#pragma once

#include "runtime/result.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace penumbra {

struct FileHead {
    std::vector<std::byte> bytes;
    std::uint64_t fileBytes = 0; // more than bytes.size() where the file goes on
};

// The first bytes of a regular file, at most `maxBytes`. A folder or a missing file is an Error.
Result<FileHead> readFileHead(const std::filesystem::path& path, std::uint64_t maxBytes);

// The bytes of a regular file of at most `maxBytes`. A larger one is an Error too.
Result<std::vector<std::byte>> readFile(const std::filesystem::path& path, std::uint64_t maxBytes);

// Writes to a temporary name in the same folder and renames it over `path`; creates the folder.
Result<void> writeFile(const std::filesystem::path& path, std::span<const std::byte> bytes);
Result<void> writeFile(const std::filesystem::path& path, const std::string& text);

// Error where writeFile would fail for sure: the path is a folder, or the folder
// that it will lie in cannot be made or written. Writes nothing. Before any work.
Result<void> checkWritable(const std::filesystem::path& file);

} // namespace penumbra
