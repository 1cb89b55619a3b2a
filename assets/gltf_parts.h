// The pieces of glTF that all parts of the mesh codec write and read: accessors and bufferViews.
#pragma once

#include "assets/json_reader.h"

#include <cstddef>
#include <span>

namespace penumbra {

// Elements of any one array that a reader follows: 256 submeshes of 5 geometries have 10 accessors.
constexpr std::size_t kMaxGltfElements = 16384;

// glTF's enumerators
constexpr int kGltfUnsignedByte = 5121, kGltfUnsignedInt = 5125, kGltfFloat = 5126;

// A document under construction and its BIN chunk.
struct GltfWriter {
    nlohmann::json document;
    std::vector<std::byte> bin;

    // A bufferView over `part`, appended to `bin` at a multiple of 4: its index.
    std::size_t addView(std::span<const std::byte> part);

    // An accessor without a bufferView: its index.
    std::size_t addAccessor(int componentType, const char* type, std::size_t count);

    // Names the extension in extensionsUsed, once.
    void useExtension(const char* name);
};

// The bytes of bufferView `index`, which must lie in the BIN chunk; none, and a problem, where not.
std::span<const std::byte> readView(const JsonReader& root, std::uint64_t index,
                                    std::span<const std::byte> bin);

} // namespace penumbra
