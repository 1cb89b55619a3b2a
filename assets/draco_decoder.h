// libdraco's mesh decoders behind bounds. A payload of a few bytes can say that it holds any number
// of vertices, attributes and components, and libdraco takes the memory before it looks for the
// data. Here each count is read ahead and the memory that follows from it added up first.
#pragma once

#include "assets/mesh_asset.h"

#include <cstddef>
#include <memory>
#include <span>

namespace draco {
class Mesh;
}

namespace penumbra {

// What a payload may hold at most; for a file that declares its counts, those.
struct DracoLimits {
    std::uint64_t vertices = kMaxMeshVertices;
    std::uint64_t triangles = kMaxMeshTriangles;
};

// What decoding takes at most, in bytes: for each triangle kDracoTriangleBytes and once more
// kDracoSeamBytes for each attribute with seams; for each vertex and attribute
// kDracoAttributeBytes, and for each component of it its size and 4.
PENUMBRA_CONST std::uint64_t kDracoTriangleBytes = 160;
PENUMBRA_CONST std::uint64_t kDracoSeamBytes = 72;
PENUMBRA_CONST std::uint64_t kDracoAttributeBytes = 16;
PENUMBRA_CONST std::uint64_t kMaxDracoBytes = 2ull << 30; // a payload that takes more is refused

// A triangle mesh of bitstream 2.2, by any method. Corners are vertices of it.
Result<std::unique_ptr<draco::Mesh>> decodeDracoMesh(std::span<const std::byte> bytes,
                                                     const DracoLimits& limits);

} // namespace penumbra
