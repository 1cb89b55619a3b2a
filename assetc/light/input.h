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

// None: `problems`, which is empty before, gets those of the description, or where it has none, of
// the files that it names. `asked`, if any, gets these and those that its mesh names, all beside
// the description.
std::optional<LightInput> readLightInput(const std::filesystem::path& path, JsonProblems& problems,
                                         std::vector<AskedFile>* asked = nullptr);

} // namespace penumbra
