// Environment maps from files: equirectangular .hdr (Radiance RGBE) and .exr (OpenEXR, scanline or
// tiled, any compression, channels R, G, B or Y), to the Environment that assets/environment.h
// stores. What is wrong with real maps is mended and counted in the statistics:
//   negative or NaN channel      0 (lossy DWA leaves them in most published maps)
//   absurd pixel                 lowered, hue kept. Absurd is (1) what the half floats of the map
//   cannot hold after the
//                                box filter; (2) a pixel that alone sends more power (luminance x
//                                solid angle) than all others together and is brighter than
//                                kAbsurdLuminance: it is lowered to the power of the others, or to
//                                kAbsurdLuminance. A real sun in a map of usual size stays below
//                                (2): of 29 published maps none is touched.
//   EXPOSURE lines of a .hdr     undone: the map holds radiance, as Radiance defines the lines
//   larger than 512 x 256        box filter with solid-angle weights, which keeps the power of
//   every region
#pragma once

#include "assets/environment.h"

#include <filesystem>
#include <string>

namespace penumbra {

PENUMBRA_CONST std::uint32_t kMaxSourceWidth = 16384, kMaxSourceHeight = 8192;
PENUMBRA_CONST std::uint64_t kMaxPictureBytes = 1ull << 30;
PENUMBRA_CONST float kAbsurdLuminance =
    1000.0f; // W/(m² sr); no lamp of a usually exposed map, where white is about 1

// A decoded picture, before anything is mended. Width / height is 2, give or take a pixel.
struct EnvironmentSource {
    std::uint32_t width = 0, height = 0;
    std::vector<vec3>
        pixels; // [height][width] linear Rec. 709, row 0 is the top; any float, NaN too
};

// The file's pixels; the format is told by the content, not the name. Error: not a regular file,
// too large, damaged, not 2:1, not an equirectangular map, no such channels.
Result<EnvironmentSource> readEnvironmentSource(const std::filesystem::path& path);

// The largest picture that gets memory.
struct PictureLimit {
    std::uint32_t width = kMaxSourceWidth, height = kMaxSourceHeight;
};

// The same from bytes in memory; any proportions.
Result<EnvironmentSource> decodeRadianceHdr(std::span<const std::byte> bytes,
                                            PictureLimit limit = {});
Result<EnvironmentSource> decodeOpenExr(std::span<const std::byte> bytes, PictureLimit limit = {});

// Mends and filters as above. `source.pixels` may hold anything.
Environment environmentFromSource(EnvironmentSource source);

Result<Environment> importEnvironment(const std::filesystem::path& path);

// "3 pixels with a negative channel and 1 absurd pixel were clamped", where some were; a black map.
std::vector<std::string> environmentWarnings(const EnvironmentStatistics& statistics);

// JSON: {"map":[w,h],"source":[w,h],"negative","absurd","clampedAt","meanLuminance","maxLuminance",
// "energyShare":{"order4","order6"}, "sh4":[[r,g,b] x 16]}. Ends in a line feed.
std::string environmentReport(const Environment& environment);

} // namespace penumbra
