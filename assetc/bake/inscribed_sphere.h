// A ball that fits into the object: whatever lies behind it is hidden (Zhou et al. 2005, section
// 4.2).
#pragma once

#include "assetc/bake/field_samples.h"

namespace penumbra {

class EmbreeScene;

// Centre and radius, object space, metres; radius 0: none was found. `field`: after fillInside, no
// shell left out; `scene`: the surface, object space. The ball meets no triangle, and its centre
// and six points around it see nothing of the outside: a mesh need not be closed, but what is
// hollow and can be looked into has no ball there. A large one, not always the largest: from the
// best of the coarse nodes inside, uphill in the distance from the surface. `basis`: as
// traceBlocked() has it, summing to the sphere's 4 pi.
vec4 inscribedSphere(const EmbreeScene& scene, const FieldSamples& field,
                     const std::vector<vec3>& directions, const std::vector<Sh4>& basis);

} // namespace penumbra
