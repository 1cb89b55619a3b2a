// An environment map as the frame uses it: radiance in SH for light, a small equirectangular map to
// look at and to importance-sample. Both say the same by construction: the SH are projected from
// the very map that is kept, after its rounding to half floats, so light, background and the
// ray-traced truth agree, and a difference between picture and truth is never one between two maps.
// File format .env: docs/asset_format.md. World space, +Y up; the mapping of the map is
// shaders/shared/environment.h: row 0 looks up, the middle column along +X. Radiance is constant
// over a map pixel, that is, the map is a function on the sphere without a filter.
#pragma once

#include "runtime/result.h"
#include "shaders/shared/interop.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra {

PENUMBRA_CONST std::uint32_t kMaxEnvironmentWidth =
    512; // finer than any shadow the SH of order 6 can carry
PENUMBRA_CONST std::uint32_t kMaxEnvironmentHeight = 256;
PENUMBRA_CONST float kMaxEnvironmentRadiance = 65504.0f; // the largest half float

struct EnvironmentStatistics {
    std::uint32_t sourceWidth = 0, sourceHeight = 0;
    std::uint64_t negative =
        0;                    // source pixels with a negative or NaN channel, that channel set to 0
    std::uint64_t absurd = 0; // source pixels lowered to `clampedAt`, see assetc/environment.h
    float clampedAt = 0;      // luminance, W/(m² sr); 0: nothing was lowered
    float meanLuminance = 0;  // of the map over the sphere, W/(m² sr)
    float maxLuminance = 0;   // of the map, W/(m² sr)
};

struct Environment {
    std::array<vec3, 16> sh4{}; // radiance, linear Rec. 709, W/(m² sr); index l(l+1)+m
    std::array<vec3, 36> sh6{}; // the same with order 6; its first 16 are sh4
    std::uint32_t mapWidth = 0, mapHeight = 0;
    std::vector<vec3> map; // [mapHeight][mapWidth] radiance, finite, >= 0, half-float values
    EnvironmentStatistics statistics;
};

// Makes the environment of a map: rounds it to half floats, projects it to SH with the exact solid
// angle of each row, fills mean and maximum. For procedural skies and for assetc. Sizes in 1 …
// kMaxEnvironmentWidth/Height and values finite, >= 0 and <= kMaxEnvironmentRadiance (asserted).
Environment makeEnvironment(std::uint32_t width, std::uint32_t height, std::vector<vec3> map);

// Solid angle in sr of one pixel of row `y` of a width x height map; the rows times `width` sum to
// 4 pi.
double equirectPixelSolidAngle(std::uint32_t width, std::uint32_t height, std::uint32_t y);

// Luminance of linear Rec. 709.
PENUMBRA_FN float luminance(vec3 c)
{
    return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b;
}

// Share of the map's energy (the integral of the squared radiance, summed over RGB) that the SH of
// `order` (1 … 6) hold, 0 … 1: how well SH of this order stand for the map. A black map gives 1.
double environmentEnergyShare(const Environment& environment, int order);

// Bytes of a .env file, the same for the same environment. Decoding trusts nothing: any byte string
// gives an environment that holds every promise above (sh4 and map included), or an Error that
// names the place.
Result<std::vector<std::byte>> encodeEnvironment(const Environment& environment);
Result<Environment> decodeEnvironment(std::span<const std::byte> bytes);

} // namespace penumbra
