// Adaptive shells: Tamura et al. 2006, section 4. Occlusion varies slowly far from an object, so
// most shells need a coarser grid than those near it.
#pragma once

#include "assets/shadow_field.h"

namespace penumbra {

constexpr float kDefaultAdaptThreshold = 0.010f; // Tamura et al. 2006, section 6.1
// 1,296 bytes per shell: less would save nothing that counts, and a cell spans 45 degrees already.
constexpr std::uint32_t kMinAdaptedSide = 9;

struct AdaptReport {
    std::uint64_t bytesBefore = 0; // of the texels
    std::uint64_t bytesAfter = 0;
    float worst = 0; // largest Eq. (1) error of a replaced node
};

// Halves the grid of every shell, 65 to 33, 17, 9 nodes, while the error at every node of the first
// grid stays below `threshold`. The error is Eq. (1), the mean over all directions of the absolute
// difference between the node's function and what the coarser grid gives there,
//     Error = 1 / (4 pi) integral |sum_g (O'_g - O_g) Psi_g(w)| dw,
// on the quantised values, by the 32-point rule. Sides are 2^k + 1, so the coarser grid's nodes are
// nodes of the finer one. All channels and frames of a shell keep one side.
AdaptReport adaptShells(ShadowField& field, float threshold);

} // namespace penumbra
