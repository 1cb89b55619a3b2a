// A MeshGeometry as the primitives of a glTF mesh, one Draco payload per submesh, and back.
#pragma once

#include "assets/draco_mesh.h"
#include "assets/gltf_parts.h"

namespace penumbra {

struct EncodedPrimitives {
    nlohmann::json primitives;
    std::string checksum; // of the payloads, one after the other
};

// `geometry` is valid (validateMesh). All geometries of a file share the lattice of positions, so
// that submeshes meet without cracks and LODs keep the full mesh's vertices.
Result<EncodedPrimitives> encodePrimitives(const MeshGeometry& geometry,
                                           const PositionLattice& lattice,
                                           const MeshEncodeOptions& options, GltfWriter& out);

// Moves positions, normals and texture coordinates to where a reader of the payloads will see them.
Result<void> quantizeGeometry(MeshGeometry& geometry, const MeshEncodeOptions& options);

// Reads the primitives of `mesh`, whose counts together keep the limits, each with the same
// attributes. `materialCount` of them are there; a primitive without one gets materialCount.
// Records problems; validateMesh has yet to see the values.
MeshGeometry decodePrimitives(const JsonReader& root, const JsonReader& mesh,
                              std::uint32_t materialCount, std::span<const std::byte> bin,
                              JsonProblems& problems);

} // namespace penumbra
