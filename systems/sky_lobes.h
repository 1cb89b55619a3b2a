// Skies filtered by Phong lobes, for sharp reflections (shaders/shared/gloss.h).
#pragma once

#include "assets/environment.h"
#include "shaders/shared/gloss.h"

namespace penumbra {

// [kSkyLobeTexels] (gloss.h) mean radiance around each direction, W/(m² sr), w unused; level k
// weighs directions by t^(e + 1), t the cosine to the direction and e = 4 2^k: a Phong lobe times
// the cosine, seen along the normal.
struct SkyLobes {
    std::vector<vec4> texels; // empty: not made
};

// By sums over the map's pixels, or over fewer, larger ones where the lobe is wide. The map's axes.
// 0.2 s on two cores.
SkyLobes filterSky(const Environment& environment);

// sum += intensity * sky (not empty; an empty sum is black), turned by the unit quaternion
// `rotation` (world from map).
void addTurned(SkyLobes& sum, const SkyLobes& sky, float intensity, vec4 rotation);

// As the kernels read it; `sky` is not empty. `exponent` is clamped to the levels.
vec3 filteredSky(const SkyLobes& sky, vec3 direction, float exponent);

} // namespace penumbra
