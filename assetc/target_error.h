// The cheapest bake that reaches an error.
#pragma once

#include "assetc/adapt.h"
#include "assetc/bake.h"

namespace penumbra {

// One bake that was tried and what it measured.
struct TargetTrial {
    BakeOptions options;
    float threshold = 0; // of adaptation
    float error = 0;     // of readers, directions included: sqrt(total² + directions²), rms
    std::uint64_t bytes = 0;
    double seconds = 0;
};

struct TargetReport {
    std::vector<TargetTrial> trials; // the last one is what is used
    bool reached = false;
};

struct TargetBake {
    BakeResult baked; // of the last trial, before adaptation
    TargetReport report;
};

// From a coarse bake on, doubles what causes most of the error: the side where that is angular, the
// shells where radial, the directions where noise, until the error is at most `target`; halves the
// threshold where adaptation causes it. Ends at 129 nodes, 121 shells and 16,384 directions, or
// where nothing helps. Begins with `threshold`; of `options` shells, side and directions do not
// count. Deterministic.
TargetBake bakeToError(const MeshAsset& mesh, float target, BakeOptions options, float threshold,
                       Progress& progress);

} // namespace penumbra
