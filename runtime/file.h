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

// The bytes of a regular file of at most `maxBytes`. A folder, a missing file or a larger one is an
// Error.
Result<std::vector<std::byte>> readFile(const std::filesystem::path& path, std::uint64_t maxBytes);

// Writes to a temporary name in the same folder and renames it over `path`; creates the folder.
Result<void> writeFile(const std::filesystem::path& path, std::span<const std::byte> bytes);
Result<void> writeFile(const std::filesystem::path& path, const std::string& text);

} // namespace penumbra
