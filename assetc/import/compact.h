// Materials and images down to those in use.
#pragma once

#include "assets/mesh_asset.h"

namespace penumbra {

// Numbers materials by first use in `materialOf` [triangleCount], alike ones (but for the name) as
// one, and their images likewise; drops the others, texture coordinates that no texture uses, and
// colours that are all white. A mesh without materials keeps none.
void compactMaterials(MeshAsset& mesh, std::vector<std::uint32_t>& materialOf);

} // namespace penumbra
