// A field as it is baked: floats, before it is stored as bytes.
#pragma once

#include "assets/shadow_field.h"
#include "shaders/shared/sh.h"

#include <vector>

namespace penumbra {

// `nodes` lie as the texels of the field will: [frame][channel][shell][y][x]. Each holds the
// deviation from "nothing in the way" (occlusion: at most 0 in c_0) or the radiance itself.
struct FieldSamples {
    ShadowField head; // all but bandScale and texels
    std::vector<Sh4> nodes;
    // [nodes] points that see nothing because they lie in the object: no receiver is there, and
    // they hold what the space around continues to. Empty: none.
    std::vector<bool> inside;
};

// c_0 of a point that sees nothing, but for the rounding of the sum over directions.
PENUMBRA_CONST float kSeesNothing = -0.9995f * kSqrt4Pi;

// Index of a grid's first node; grids are counted as in fieldGrid (assets/shadow_field.h).
std::size_t firstNode(const ShadowField& field, std::size_t grid);

// Where node (x, y) of a grid of side `to` lies on one of side `side`; both sides 2^k + 1.
struct GridPlace {
    std::size_t low; // index of the lower corner of its cell
    float x, y;      // from there, in cells
};
GridPlace placeOnGrid(std::uint32_t side, std::uint32_t to, std::uint32_t x, std::uint32_t y);

// The parts of the coefficients of shells `from` and `to` that readers find at shell s between
// them, if those between were left out: linear in the quantised values, which are the coefficients
// over g(r).
struct ShellBlend {
    float from, to;
};
ShellBlend blendBetween(const ShadowField& field, std::size_t from, std::size_t to, std::size_t s);

// A grid [y][x] on another side, bilinear between its nodes; both sides 2^k + 1.
std::vector<Sh4> refineNodes(const std::vector<Sh4>& grid, std::uint32_t side, std::uint32_t to);

// One frame and channel on one side, left out shells included: [shell][y][x], coefficients over
// g(r), in which readers interpolate.
std::vector<Sh4> refineNodes(const FieldSamples& samples, std::size_t grid, std::uint32_t side);

// Band scales from the largest node of each band, and bytes: to the nearest step.
ShadowField quantiseField(const FieldSamples& samples);

} // namespace penumbra
