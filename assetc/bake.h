// Baking of visibility by line-space rasterisation: per direction of an antipodal set, the mesh is
// rasterised once orthographically, keeping the nearest and farthest depth of every line; a sample
// p is blocked along w if the farthest depth on its line lies beyond p.w, and along -w if the
// nearest lies before it. Close to a surface, depths are interpolated between lines; beside it, and
// where next to nothing is seen, the sample is traced by Embree. One raster serves every sample of
// every shell, inside the bounding sphere too, and every vertex. Outside 1.03 radii a sample asks
// for the whole cell of the sphere that a direction stands for, as a square of lines: a half to
// a fifth of the noise. Deterministic for any thread count, on one type of processor (Embree's).
#pragma once

#include "assetc/bake/field_samples.h"
#include "assetc/bake/probes.h"
#include "assetc/progress.h"
#include "assets/mesh_asset.h"

namespace penumbra {

// Sides of the shells before adaptation makes any coarser: half of `side` where more is not worth
// its time. Inside half the bounding radius that is as fine, in metres, as the full side outside;
// from two radii on it errs by less than half of the default threshold (docs/decisions/0006).
std::vector<std::uint16_t> bakedSides(const ShadowField& field, std::uint32_t side);

// Pixels across the bounding sphere that err no more than so many directions do: 10 times the
// square root of their number, 320 to 1,024.
std::uint32_t rasterSideFor(std::uint32_t directions);

struct BakeOptions {
    std::uint32_t shells = 32;
    std::uint32_t side = 65;         // 2^k + 1
    std::uint32_t directions = 1024; // even
    std::uint32_t rasterSide = 0;    // pixels across the bounding sphere; 0: rasterSideFor
    bool field = true;
};

struct BakeResult {
    std::vector<SelfVisibility> selfVisibility; // [vertexCount]
    FieldSamples field;                         // no nodes without options.field
    std::vector<Probe> probes;                  // the exact field off the grid
};

// Error: the mesh is too small or too large to bake.
Result<void> checkExtent(const MeshAsset& mesh);

// `positions`, `normals` [vertexCount], `indices` [3 * triangleCount] valid, of a mesh that passes
// checkExtent. Uses the TBB arena of the caller.
BakeResult bakeMesh(const std::vector<vec3>& positions, const std::vector<vec3>& normals,
                    const std::vector<std::uint32_t>& indices, const BakeOptions& options,
                    Progress& progress);

} // namespace penumbra
