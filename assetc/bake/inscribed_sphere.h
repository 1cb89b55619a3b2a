// A ball that fits into the object: whatever lies behind it is hidden (Zhou et al. 2005, section
// 4.2).
#pragma once

#include "assetc/bake/field_samples.h"

namespace penumbra {

class EmbreeScene;

// Centre and radius, object space, metres; radius 0: none was found. `field`: after fillInside;
// `scene`: the surface, object space. The centre sees nothing of the outside and the ball meets no
// triangle, so a ray that passes through the ball is blocked. A large one, not always the largest:
// from the best of the coarse nodes inside, uphill in the distance from the surface.
vec4 inscribedSphere(const EmbreeScene& scene, const FieldSamples& field);

} // namespace penumbra
