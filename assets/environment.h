// An environment map as the frame uses it: radiance in SH for light, a small equirectangular map to look at.
// File format .env: docs/asset_format.md. Space: world, +Y up; column 0 of the map looks along -X … see `directionOf`.
#pragma once

#include "runtime/result.h"
#include "shaders/shared/interop.h"

#include <array>
#include <span>
#include <vector>

namespace penumbra {

struct EnvironmentStatistics {
    std::uint32_t sourceWidth = 0, sourceHeight = 0;
    std::uint64_t negative = 0;   // pixels with a negative or non-finite channel, clamped to 0
    std::uint64_t absurd = 0;     // pixels above `clampedAt`, clamped to it
    float clampedAt = 0;          // W/(m² sr)
    float meanLuminance = 0;      // over the sphere, after clamping
    float maxLuminance = 0;       // after clamping
};

struct Environment {
    std::array<vec3, 16> sh4{};       // radiance, linear Rec. 709, W/(m² sr); index l(l+1)+m
    std::array<vec3, 36> sh6{};       // the same with order 6
    std::uint32_t mapWidth = 0, mapHeight = 0;
    std::vector<vec3> map;            // [mapHeight][mapWidth] radiance, row 0 looks up; small, for the background
    EnvironmentStatistics statistics;
};

// The direction that the equirectangular coordinates (u, v) in [0,1]² look at: v = 0 is +Y. The one mapping of the project,
// also in shaders/shared/environment.h for the background pass.
Result<std::vector<std::byte>> encodeEnvironment(const Environment& environment);
Result<Environment> decodeEnvironment(std::span<const std::byte> bytes);

} // namespace penumbra
