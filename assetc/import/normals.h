// Normals for meshes that lack them.
#pragma once

#include "assets/mesh_asset.h"

namespace penumbra {

// A normal for each of the 3 * triangleCount corners: the given one where it has a length, made a
// unit vector; else the mean, weighted by the angle at the corner (Thürmer and Wüthrich 1998), of
// the faces that are reached around the corner's exact position over edges less sharp than
// kCreaseCosine. Triangles must have an area.
std::vector<vec3> cornerNormals(const MeshAsset& mesh);

// 60 degrees: boxes and machine parts have edges of 90, coarse spheres less than 45.
PENUMBRA_CONST float kCreaseCosine = 0.5f;

} // namespace penumbra
