// Mesh assets as bytes: a standard glTF 2.0 binary with Draco geometry and the extension PENUMBRA_shadow_field
// (docs/asset_format.md). Encoding is deterministic. Decoding trusts nothing: any byte string gives a valid asset or an
// Error that names the place.
#pragma once

#include "assets/mesh_asset.h"

#include <span>

namespace penumbra {

struct MeshEncodeOptions {
    int positionBits = 16; // Draco quantisation of the bounding box
    int normalBits = 12;   // octahedral
};

Result<std::vector<std::byte>> encodeMeshAsset(const MeshAsset& mesh, const MeshEncodeOptions& options = {});
Result<MeshAsset> decodeMeshAsset(std::span<const std::byte> bytes);

} // namespace penumbra
