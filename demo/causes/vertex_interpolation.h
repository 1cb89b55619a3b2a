// What it costs to have light at vertices only: the truth at points of triangles that the camera
// sees, against the truth at their corners, interpolated.
#pragma once

#include "demo/reference/reference.h"

namespace penumbra {

// About `points` pixels, a net over the picture, by options.samples rays each and per corner;
// surfaces that shine are left out. Both sides use the same sample points.
RadianceErrors vertexInterpolation(const ReferenceScene& scene, const ReferenceLighting& lighting,
                                   const ReferenceCamera& camera, std::uint32_t points,
                                   const ReferenceOptions& options);

} // namespace penumbra
