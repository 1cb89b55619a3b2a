// Pictures of a mesh as pixels.
#pragma once

#include "assets/mesh_material.h"
#include "runtime/result.h"

#include <cstdint>

namespace penumbra {

PENUMBRA_CONST std::uint32_t kMaxTextureSide = 8192; // 256 MiB as pixels

struct DecodedImage {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba; // [height][width][4] row 0 the top; colours as in the file
};

// Trusts nothing. Error: neither PNG nor JPEG, cut off or damaged, or a side beyond `maxSide`,
// which is found before its pixels get memory.
Result<DecodedImage> decodeImage(const MeshImage& image, std::uint32_t maxSide = kMaxTextureSide);

struct MipChain {
    std::uint32_t levels = 1;
    std::vector<std::uint8_t> rgba; // one level after the other
};

// Levels of half the size, rounded down, to one pixel. Each pixel is the mean of the area that it
// covers in the level before: of colours in linear light, since they are sRGB, weighted by alpha,
// so that colours of transparent pixels do not bleed; of alpha as it is.
MipChain makeMipChain(DecodedImage image);

} // namespace penumbra
