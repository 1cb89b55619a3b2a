// Normals for meshes that lack them.
#pragma once

#include "assets/mesh_asset.h"

namespace penumbra {

// A normal for each of the 3 * triangleCount corners: the given one where it has a length, made a
// unit vector; else the mean, weighted by the angle at the corner (Thürmer and Wüthrich 1998), of
// the faces around the corner's exact position whose normals lie within kCreaseAngle of this
// face's. Faces around more than 256-fold corners all blend. Triangles must have an area.
std::vector<vec3> cornerNormals(const MeshAsset& mesh);

// Sharper edges stay sharp: boxes and machine parts have 90 degrees, coarse spheres less than 45.
PENUMBRA_CONST float kCreaseCosine = 0.5f; // 60 degrees

} // namespace penumbra
