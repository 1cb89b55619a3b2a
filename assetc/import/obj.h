// Wavefront OBJ.
#pragma once

#include "assetc/import/imported_mesh.h"

#include <filesystem>

namespace penumbra {

// All faces of the file, triangulated. Material libraries and the images of map_Kd are read only
// from the file's own folder; of materials Kd, d and map_Kd count. An index that names nothing is
// refused with its place.
Result<ImportedMesh> importObj(const std::filesystem::path& path);

} // namespace penumbra
