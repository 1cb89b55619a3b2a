// An independent check of a baked field: rays instead of rasters.
#pragma once

#include "assetc/bake/field_samples.h"
#include "assets/mesh_asset.h"

namespace penumbra {

struct VerifyOptions {
    std::uint32_t samples = 512; // field samples, drawn at random with a fixed seed
    std::uint32_t seed = 1;
};

// Baked coefficients against coefficients from rays; unit: visibility (an open sphere has c_0 =
// sqrt(4 pi) = 3.54).
struct VerifyReport {
    std::uint32_t samples = 0;
    std::uint32_t directions = 0;
    float rms = 0;
    float max = 0;
    float worstRadius = 0; // where the maximum is, bounding radii
};

// Traces field.head.directions rays from each drawn node of the field as it was baked, before
// adaptation and quantisation, with Embree; nodes inside the mesh are not drawn. Near the object
// the directions are the same, and the difference is that of the raster; far from it the bake takes
// whole cells of directions, and the difference holds the noise of the rays. Deterministic for any
// thread count.
VerifyReport verifyBake(const MeshAsset& mesh, const FieldSamples& field,
                        const VerifyOptions& options = {});

} // namespace penumbra
