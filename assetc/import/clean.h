// From what files contain to what the compiler works on.
#pragma once

#include "assets/mesh_asset.h"

namespace penumbra {

struct CleanReport {
    std::size_t degenerateTriangles = 0; // dropped
    std::size_t mergedVertices = 0;      // alike in all, or used by no triangle
    std::size_t generatedNormals = 0; // vertices of the result whose normal the file did not give
};

// Afterwards: at least one triangle and none without area, every vertex used, no two vertices
// alike, unit normals, sizes and coordinates within the limits of mesh_asset.h. Missing normals are
// generated (assetc/import/normals.h). One submesh per material, alike materials joined; materials
// and images that no triangle uses are gone, as are texture coordinates that no texture uses: they
// would split vertices, which are receivers. Error: a coordinate that is not finite or too large,
// no triangle left, too many vertices or materials.
Result<CleanReport> cleanMesh(MeshAsset& mesh);

} // namespace penumbra
