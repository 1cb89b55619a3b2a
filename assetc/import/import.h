// Triangles out of a .glb, .gltf or .obj file.
#pragma once

#include "assetc/import/folder.h"
#include "assetc/import/imported_scene.h"

#include <filesystem>

namespace penumbra {

// The format is told by the content (assetc/file_type.h). Any bytes give a mesh or an Error that
// names the place. The mesh may have no triangles, degenerate ones and missing normals:
// assetc/import/clean.h comes next. `asked` gets the other files that the file names (buffers,
// material libraries), of a file that is refused too.
Result<ImportedMesh> importMesh(const std::filesystem::path& path,
                                std::vector<AskedFile>* asked = nullptr);

// The same file with its hierarchy; of an OBJ file one node.
Result<ImportedScene> importScene(const std::filesystem::path& path,
                                  std::vector<AskedFile>* asked = nullptr);

} // namespace penumbra
