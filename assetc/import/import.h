// Triangles out of a .glb, .gltf or .obj file.
#pragma once

#include "assetc/import/imported_scene.h"

#include <filesystem>

namespace penumbra {

// The format follows the extension. Any bytes give a mesh or an Error that names the place. The
// mesh may have no triangles, degenerate ones and missing normals: assetc/import/clean.h comes
// next.
Result<ImportedMesh> importMesh(const std::filesystem::path& path);

// The same file with its hierarchy; of an OBJ file one node.
Result<ImportedScene> importScene(const std::filesystem::path& path);

} // namespace penumbra
