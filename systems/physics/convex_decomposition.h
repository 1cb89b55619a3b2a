// Splits a concave mesh into convex pieces for compoundShape: a mug into its wall, a knot into its
// bends.
#pragma once

#include "runtime/result.h"
#include "shaders/shared/interop.h"

#include <span>
#include <vector>

namespace penumbra {

struct DecompositionOptions {
    int maxPieces = 24;  // [1, 256]
    int resolution = 40; // voxels along the longest side, [8, 128]
    float concavity =
        0.01f; // stop when the pieces together enclose less than this share of air, [0, 1]
};

// The mesh (closed, indices in triples; closed parts may overlap) is filled with voxels, which are
// cut in two along axis-aligned planes, the piece with the most air in its hull first. Each result
// is the hull points of what the mesh has within one piece's voxels. The same input gives the same
// bits. 0.1 to 2 s; run it once per asset. Errors: options out of range, indices out of range,
// coordinates that are not finite, a mesh that encloses nothing.
Result<std::vector<std::vector<vec3>>> decompose(std::span<const vec3> positions,
                                                 std::span<const std::uint32_t> indices,
                                                 const DecompositionOptions& options = {});

} // namespace penumbra
