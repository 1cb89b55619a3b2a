// From an emitter to its source radiance field (Zhou et al. 2005, section 3.1).
#pragma once

#include "assetc/adapt.h"
#include "assetc/light/emitter.h"
#include "assetc/progress.h"

namespace penumbra {

struct LightFieldOptions {
    std::uint32_t shells = 32;
    std::uint32_t side = 65;   // 2^k + 1
    float innerRadius = 0.2f;  // bounding radii
    float outerRadius = 64.0f; // bounding radii
};

// Samples the emitter at every node; 3 channels. Uses the TBB arena of the caller; the same bytes
// for any thread count.
FieldSamples bakeLightField(const Emitter& emitter, const LightFieldOptions& options,
                            Progress& progress);

// adaptShells with a threshold that is relative to the light. Radiance has no unit size and falls
// with g(r), so the error of Eq. (1) is divided by g(r) and by the largest mean radiance over g(r)
// of any node: `threshold` is a part of the light at the brightest place, wherever the shell.
AdaptReport adaptLightShells(FieldSamples& field, float threshold);

} // namespace penumbra
