// The mesh of the bake benchmarks, at any number of triangles.
#pragma once

#include "assets/mesh_asset.h"

namespace penumbra {

// The (2, 3) torus knot as a closed tube of about `triangles` triangles, with normals.
MeshAsset torusKnot(std::size_t triangles);

} // namespace penumbra
