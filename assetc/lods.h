// Levels of detail of a baked mesh.
#pragma once

#include "assets/mesh_asset.h"

namespace penumbra {

// Sets mesh.lods: at most `count` (kMaxMeshLods), each with half the triangles of the one before,
// by meshopt_simplify on the full mesh; vertices keep all that they have and are ordered into
// clusters anew. Fewer where the simplifier stalls, or where a vertex of the mesh would be farther
// than kMaxLodError of its size from the level. Deterministic.
void buildLods(MeshAsset& mesh, std::uint32_t count);

PENUMBRA_CONST float kMaxLodError = 0.1f; // beyond, the level no longer looks like the mesh

} // namespace penumbra
