// Visibility by tracing rays: what the bake and its field are measured against.
#pragma once

#include "shaders/shared/sh.h"

#include <embree3/rtcore.h>
#include <vector>

namespace penumbra {

// Sum of the basis of the blocked directions of a point. Rays begin at the point itself.
Sh4 traceBlocked(RTCScene scene, vec3 origin, const std::vector<vec3>& directions,
                 const std::vector<Sh4>& basis);

// Visibility at a point in SH: unoccluded minus the blocked directions. `directions` cover the
// sphere evenly, `basis` is shBasis of each.
Sh4 traceVisibility(RTCScene scene, vec3 origin, const std::vector<vec3>& directions,
                    const std::vector<Sh4>& basis);

} // namespace penumbra
