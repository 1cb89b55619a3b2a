// An independent check of a baked field: rays instead of rasters.
#pragma once

#include "assets/mesh_asset.h"

namespace penumbra {

struct VerifyOptions {
    std::uint32_t samples = 512; // field samples, drawn at random with a fixed seed
    std::uint32_t seed = 1;
};

// Stored coefficients against coefficients from rays; unit: visibility (an open sphere has c_0 =
// sqrt(4 pi) = 3.54).
struct VerifyReport {
    std::uint32_t samples = 0;
    std::uint32_t directions = 0;
    float rms = 0;
    float max = 0;
    float worstRadius = 0; // where the maximum is, bounding radii
};

// Traces mesh.field->directions rays from each drawn sample with Embree. The difference holds the
// 8-bit quantisation and the raster's resolution, not the number of directions, which are the same.
// Error: a mesh without an occlusion field. Deterministic for any thread count.
Result<VerifyReport> verifyBake(const MeshAsset& mesh, const VerifyOptions& options = {});

} // namespace penumbra
