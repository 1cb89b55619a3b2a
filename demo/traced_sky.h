// The environments of a scene as lights that rays can sample.
#pragma once

#include "demo/reference/light.h"
#include "demo/scene.h"

namespace penumbra {

struct TracedSky {
    ReferenceLight maps;   // the maps themselves, what is above the ground of them
    ReferenceLight order4; // their SH of order 4, rotated as directions are, not as coefficients
};

// All EnvironmentLights as they are now.
TracedSky tracedSky(const DemoScene& scene);

} // namespace penumbra
