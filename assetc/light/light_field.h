// From an emitter to its source radiance field (Zhou et al. 2005, section 3.1).
#pragma once

#include "assetc/bake/field_samples.h"
#include "assetc/bake/probes.h"
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

// The largest mean radiance over g(r) of any node, in the strongest channel. Radiance has no unit
// size and falls with g(r), so thresholds and errors are parts of this times g(r): of the light at
// its brightest place, wherever the shell.
float brightestRadiance(const FieldSamples& field);

// The exact radiance at random points off the grid, [point][3 channels], for measureRadianceErrors.
std::vector<Probe> probeLight(const Emitter& emitter, const ShadowField& field);

} // namespace penumbra
