// Materials of a glTF file with the images that they use.
#pragma once

#include "assetc/import/gltf_document.h"

namespace penumbra {

struct GltfMaterials {
    std::vector<SurfaceMaterial> materials; // the file's, and one more for primitives without
    std::vector<MeshImage> images;          // of the materials in use
};

// `used` [materialCount + 1] tells which materials count: images of the others are not opened. An
// image that cannot be had (missing, outside the folder, neither PNG nor JPEG) costs its texture,
// with a warning; a reference to nothing is an Error.
Result<GltfMaterials> readGltfMaterials(const GltfDocument& document, const std::vector<bool>& used,
                                        std::vector<std::string>& warnings);

} // namespace penumbra
