// glTF 2.0, text or binary.
#pragma once

#include "assetc/import/folder.h"
#include "assetc/import/imported_mesh.h"

#include <cstddef>
#include <filesystem>
#include <span>

namespace penumbra {

// All triangle primitives of the default scene (strips and fans too), each node's transform
// applied, as one mesh in the world space of the file. Skins and morph targets are baked in the
// pose that the file stores. Draco, quantised, sparse and interleaved attributes are read;
// extensions that the file requires beyond these are refused by name. Instances
// (EXT_mesh_gpu_instancing) are so many meshes. Materials, their PNG and JPEG images and lights
// come along. Buffers that the file names are looked for in `folder`.
Result<ImportedMesh> importGltfBytes(std::span<const std::byte> bytes,
                                     const std::filesystem::path& folder,
                                     std::vector<AskedFile>* asked = nullptr);

} // namespace penumbra
