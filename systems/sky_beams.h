// The bright part of an environment as a few directional lights: what beams of light have shadow
// maps for (shaders/shared/beam.h).
#pragma once

#include "assets/environment.h"
#include "shaders/shared/beam.h"

#include <vector>

namespace penumbra {

struct SkyBeam {
    vec3 direction{0, 1, 0}; // unit, towards the light
    vec3 irradiance{0};      // W/m² on a plane across it
    float halfAngle = 0;     // radians, of the disc that is as wide
};

// rest + bright = the environment, pixel by pixel.
struct SkySplit {
    Environment rest;   // no brighter than kBrightSky times the mean luminance
    Environment bright; // what the beams stand for; without a pixel where count is 0
    std::vector<SkyBeam> beams;
};

PENUMBRA_CONST float kBrightSky =
    1.5f; // times the mean luminance; order 4 can carry the rest: docs/decisions/0015

// Over ground, the mean is that of the whole map. At most `count` beams, in the map's axes: the
// bright part is cut in two where the two halves have equal power, across its longest extent, and
// again the part of the largest power times variance (median cut, after Debevec 2005, "A median cut
// algorithm for light probe sampling"). A sky with nothing bright has none. Takes some 0.2 s for
// the largest map.
SkySplit splitSky(Environment environment, std::uint32_t count);

} // namespace penumbra
