// Wavefront OBJ.
#pragma once

#include "assetc/import/folder.h"
#include "assetc/import/imported_mesh.h"

#include <filesystem>

namespace penumbra {

// All faces of the file, triangulated. Material libraries and the images of map_Kd are read only
// from the file's own folder; of materials Kd, d and map_Kd count. An index that names nothing is
// refused with its place. Material libraries are looked for in `folder`. `text` has no byte order
// mark: the library would take it for a part of the first word.
Result<ImportedMesh> importObjText(const std::string& text, const std::filesystem::path& folder,
                                   std::vector<AskedFile>* asked = nullptr);

} // namespace penumbra
