// Adaptive shells: Tamura et al. 2006, section 4. Occlusion varies slowly far from an object, so
// most shells need a coarser grid than those near it, and some none at all.
#pragma once

#include "assetc/bake/field_samples.h"

namespace penumbra {

constexpr float kDefaultAdaptThreshold = 0.010f; // Tamura et al. 2006, section 6.1
// 1,296 bytes per shell: less would save nothing that counts, and a cell spans 45 degrees already.
constexpr std::uint32_t kMinAdaptedSide = 9;

// The error that is too large on a shell: `threshold`, in visibility; or that part of
// `radiance` g(r), since radiance has no unit size and falls with the distance.
struct AdaptLimit {
    float threshold = 0;
    float radiance = 0; // 0: visibility
};

struct AdaptReport {
    std::uint64_t bytesFixed = 0; // of the texels, if all shells had the largest side
    std::uint64_t bytes = 0;
    std::uint32_t shellsDropped = 0;
    float worst = 0; // largest Eq. (1) error of a replaced node, in the unit of the threshold
};

// Halves the grid of every shell, 65 to 33, 17, 9 nodes, while the error at every node of the first
// grid stays below the limit; then drops shells, from the inside on, while the error at every
// node of every dropped one does. A dropped shell has side 0, and is what lies between its
// neighbours, linear in the shell's index and in the quantised values (assets/shadow_field.h).
//
// The error is Eq. (1), the mean over all directions of the absolute difference between the node's
// function and what the coarser field gives there,
//     Error = 1 / (4 pi) integral |sum_g (O'_g - O_g) Psi_g(w)| dw,
// by the 32-point rule. Nodes inside the object do not count. Sides are 2^k + 1, so the coarser
// grid's nodes are nodes of the finer one; they take the value there or the mean around it, as in
// the paper, whichever errs less. All channels and frames of a shell keep one side. In the end the
// nodes that are left move to where they meet the first grid best (assetc/fit_shells.h).
AdaptReport adaptShells(FieldSamples& field, const AdaptLimit& limit);

} // namespace penumbra
