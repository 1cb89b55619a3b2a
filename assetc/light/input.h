// All that a light is made of: its description and the files that it names.
#pragma once

#include "assetc/import/imported_mesh.h"
#include "assetc/light/picture.h"
#include "assetc/light/spec.h"

#include <optional>

namespace penumbra {

struct LightInput {
    LightSpec spec;
    std::optional<ImportedMesh> mesh;    // `source`, of a mesh light
    std::optional<LightPicture> texture; // where one is named
};

// Error: the first problem of any of the files, with its place. `asked`, if any, gets the files
// that the description names and those that its mesh names, all beside the description.
Result<LightInput> readLightInput(const std::filesystem::path& path,
                                  std::vector<AskedFile>* asked = nullptr);

} // namespace penumbra
