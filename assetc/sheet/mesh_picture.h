// A mesh as it looks: clay under a headlight, with the stored self-visibility as ambient light.
#pragma once

#include "assetc/embree_scene.h"
#include "assets/mesh_asset.h"
#include "runtime/canvas.h"

namespace penumbra {

// Seen from front and above (+Z, +Y), parallel projection, as large as fits. `scene` is of `mesh`.
Canvas drawMesh(const MeshGeometry& mesh, const EmbreeScene& scene, int width, int height,
                Color background);

} // namespace penumbra
