// LDR-FLIP: how different two pictures look to somebody who flips between them. 0 the same … 1 as
// different as can be. Source: Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild,
// "FLIP: A Difference Evaluator for Alternating Images", HPG 2020; constants as in the paper's
// tables. Written from the paper; all its kernels are sums of separable ones, so that the cost is
// linear in their radius.
#pragma once

#include "demo/image/image.h"

namespace penumbra {

// Of an observer 0.7 m away from a screen 0.7 m wide with 3840 pixels, the paper's default.
PENUMBRA_CONST double kFlipPixelsPerDegree = 67.0206;

struct FlipResult {
    double mean = 0;        // the number to quote
    std::vector<float> map; // [height * width] 0 … 1; show it with heatMap(…, 1)
};

// The pictures have the same size (asserted); alpha is ignored. Not symmetric by definition, but in
// fact: reference and test take the same path. Deterministic.
FlipResult flipMap(const Image8& reference, const Image8& test,
                   double pixelsPerDegree = kFlipPixelsPerDegree);

double flip(const Image8& reference, const Image8& test,
            double pixelsPerDegree = kFlipPixelsPerDegree);

} // namespace penumbra
