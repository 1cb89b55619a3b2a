// Tells damaged bytes from whole ones; no protection against somebody who means it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace penumbra {

std::uint64_t checksum(std::span<const std::byte> bytes); // XXH64, seed 0

// 16 hexadecimal digits, for JSON.
std::string checksumText(std::span<const std::byte> bytes);

// Of the parts one after another.
std::string checksumText(std::span<const std::span<const std::byte>> parts);

} // namespace penumbra
