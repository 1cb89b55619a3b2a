// glTF 2.0 with its hierarchy.
#pragma once

#include "assetc/import/folder.h"
#include "assetc/import/imported_scene.h"

#include <cstddef>
#include <filesystem>
#include <span>

namespace penumbra {

// The nodes of the default scene, parents first. Nodes that show one mesh by similarities share it;
// any other transform is partly in a mesh of its own (SplitTransform::rest). Each instance of
// EXT_mesh_gpu_instancing is a child of its node. `asked` gets the files that the document names,
// which lie in `folder`. Error: a skin, which is not rigid.
Result<ImportedScene> importGltfScene(std::span<const std::byte> bytes,
                                      const std::filesystem::path& folder,
                                      std::vector<AskedFile>* asked = nullptr);

} // namespace penumbra
