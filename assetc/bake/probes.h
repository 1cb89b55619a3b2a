// Random points off the grid where the exact field is baked too, so that a field knows its error.
#pragma once

#include "assetc/bake/point_blocks.h"
#include "shaders/shared/sh.h"

namespace penumbra {

// Three points in one random direction: at a random place between two shells, and on those shells.
struct Probe {
    vec3 direction{0}; // unit
    float shell = 0;   // place between the shells, whole part: the lower one
    Sh4 exact{};       // deviation from "nothing in the way" at the place …
    Sh4 low{}, high{}; // … and on the shells below and above
    Sh4 noise{};       // estimate of the error of `exact` by the number of directions
};

// About 10,240 probes, as many between each two shells, spread evenly in direction, in blocks for
// the bake: points 3 i, 3 i + 1 and 3 i + 2 belong to probe i (place, low, high).
struct ProbePoints {
    std::vector<Probe> probes; // directions and shells; the rest is for the bake
    PointBlocks points;
};
ProbePoints drawProbes(const ShadowField& field);

} // namespace penumbra
