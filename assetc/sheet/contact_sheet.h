// What is in a compiled asset, on one picture, for a person to look at.
#pragma once

#include "assets/environment.h"
#include "assets/mesh_asset.h"
#include "runtime/canvas.h"

#include <string>

namespace penumbra {

// The mesh; of a field a row of shells, the sides of all shells and, of an occlusion field, their
// errors. Takes a second for the rays.
Canvas drawMeshSheet(const MeshAsset& mesh, std::size_t bytes);

// The map, and what SH of order 4 and 6 hold of it.
Canvas drawEnvironmentSheet(const Environment& environment, std::size_t bytes);

// What the rows are.
std::string meshSheetText(const MeshAsset& mesh);
inline constexpr const char* kEnvironmentSheetText =
    "the map, exposed for its mean; below it what SH of order 4 and 6 hold";

} // namespace penumbra
