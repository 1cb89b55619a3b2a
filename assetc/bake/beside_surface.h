// Points so close to the surface that a raster's pixel cannot tell on which side of it they lie.
#pragma once

#include "assetc/bake/line_space.h"
#include "assetc/embree_scene.h"

namespace penumbra {

// Indices, ascending, of the points of `points` from which a triangle of `scene` is nearer than
// `distance`; both in bounding radii around `center`, `radius` in metres.
std::vector<std::size_t> pointsBeside(const EmbreeScene& scene, const PointSet& points, vec3 center,
                                      float radius, float distance);

} // namespace penumbra
