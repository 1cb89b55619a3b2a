// What tinygltf does not check.
#pragma once

#include "runtime/result.h"

#include <tiny_gltf.h>

namespace penumbra {

// Every index points at something; bufferViews lie in their buffers, accessors and sparse parts in
// their bufferViews, with counts within kMaxMeshVertices and 3 * kMaxMeshTriangles; every node has
// at most one parent and no cycle above it; matrices have their sizes. The Error names the first
// offender.
Result<void> checkModel(const tinygltf::Model& model);

} // namespace penumbra
