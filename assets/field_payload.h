// Texels of a field as the bytes of its bufferView. Encoding "delta-zstd" (docs/asset_format.md):
// per shell and coefficient one plane, each node minus its left neighbour (the first of a row minus
// the one above) modulo 256, the whole as one zstd frame. Lossless and deterministic.
#pragma once

#include "assets/shadow_field.h"

#include <cstddef>
#include <span>

namespace penumbra {

std::vector<std::byte> encodeFieldTexels(const ShadowField& field);

// Texels for a field whose head is valid (validateFieldHead): exactly fieldTexelBytes of them, or
// an Error.
Result<std::vector<std::uint8_t>> decodeFieldTexels(const ShadowField& head,
                                                    std::span<const std::byte> bytes);

} // namespace penumbra
