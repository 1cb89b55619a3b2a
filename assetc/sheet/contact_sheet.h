// What is in a compiled asset, on one picture, for a person to look at.
#pragma once

#include "assetc/sheet/canvas.h"
#include "assets/environment.h"
#include "assets/mesh_asset.h"

namespace penumbra {

// The mesh; of a field a row of shells, the sides of all shells and, of an occlusion field, their
// errors. Takes a second for the rays.
Canvas drawMeshSheet(const MeshAsset& mesh, std::size_t bytes);

// The map, and what SH of order 4 and 6 hold of it.
Canvas drawEnvironmentSheet(const Environment& environment, std::size_t bytes);

// What the rows are.
inline constexpr const char* kMeshSheetText =
    "the mesh with its self-visibility; some shells of the field as octahedral maps, a square per "
    "node (grey: mean visibility v as 1 - sqrt(1 - v); colour: radiance over the shell's "
    "brightest); the side of every "
    "shell, inner one left, no bar where left out; rms error of every shell against traced rays";
inline constexpr const char* kEnvironmentSheetText =
    "the map, exposed for its mean; below it what SH of order 4 and 6 hold";

} // namespace penumbra
