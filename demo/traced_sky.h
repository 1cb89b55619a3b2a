// The environments of a scene as lights that rays can sample.
#pragma once

#include "demo/reference/light.h"
#include "demo/scene.h"

namespace penumbra {

struct TracedSky {
    ReferenceLight maps; // the maps themselves, what is above the ground of them
    // What the frame works with: SH of order 4, rotated as directions are, not as coefficients;
    // with beams, those of what the beams leave, and the part of the maps that they stand for.
    ReferenceLight order4;
};

// All EnvironmentLights as they are now, shared among `beams` as EnvironmentLighting does.
TracedSky tracedSky(const DemoScene& scene, std::uint32_t beams = 0);

} // namespace penumbra
