// The texture of a light as linear numbers.
#pragma once

#include "runtime/result.h"
#include "shaders/shared/interop.h"

#include <filesystem>
#include <vector>

namespace penumbra {

PENUMBRA_CONST std::uint32_t kMaxLightPictureSide = 4096;

struct LightPicture {
    std::uint32_t width = 0, height = 0;
    std::vector<vec3> pixels; // [height][width] linear Rec. 709, finite, >= 0; row 0 is the top
};

// PNG and JPEG (sRGB, made linear; alpha is ignored), Radiance .hdr and OpenEXR (linear; negative
// and NaN become 0). The format is told by the content. Error: another format, damaged, a side over
// kMaxLightPictureSide, a channel over kMaxRadiance.
Result<LightPicture> readLightPicture(const std::filesystem::path& path);

} // namespace penumbra
