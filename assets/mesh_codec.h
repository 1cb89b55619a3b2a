// Mesh assets as bytes: a standard glTF 2.0 binary with Draco geometry and the extension
// PENUMBRA_shadow_field (docs/asset_format.md). Encoding is deterministic. Decoding trusts nothing:
// any byte string gives a valid asset or an Error that names the place.
#pragma once

#include "assets/mesh_asset.h"

#include <cstddef>
#include <span>

namespace penumbra {

struct MeshEncodeOptions {
    int positionBits = 16; // Draco quantisation of the bounding box, 8 to 24
    int normalBits = 12;   // octahedral, 6 to 16
};

// The largest file that decode reads.
PENUMBRA_CONST std::uint64_t kMaxMeshAssetBytes = 1u << 30;

// All but the clusters and the bounds are stored: decoding computes those from the decoded
// positions. A mesh that breaks a limit (validateMesh) is an Error. Vertices and triangles keep
// their order.
Result<std::vector<std::byte>> encodeMeshAsset(const MeshAsset& mesh,
                                               const MeshEncodeOptions& options = {});
Result<MeshAsset> decodeMeshAsset(std::span<const std::byte> bytes);

// All problems that decoding meets, each with its place; none for a valid asset.
std::vector<Error> checkMeshAsset(std::span<const std::byte> bytes);

// Moves positions and normals to where encoding will put them (up to rounding of the last bit), so
// that what is baked from a mesh fits what is shipped.
Result<void> quantizeMesh(MeshAsset& mesh, const MeshEncodeOptions& options = {});

} // namespace penumbra
