// Least squares after grids are made coarser: halving and dropping take nodes as they are, and
// straight lines between values of a curve lie on one side of it. Moved off the curve a little, the
// same nodes give a mean error near zero and a smaller one everywhere.
#pragma once

#include "assetc/bake.h"

namespace penumbra {

// One frame and channel: [shell] of [y][x], empty where the shell was left out.
using ShellGrids = std::vector<std::vector<Sh4>>;

// Nodes along the side of a grid.
std::uint32_t sideOf(const std::vector<Sh4>& grid);

// Moves the nodes of `kept` towards the least sum, over all nodes of the original grid (index as in
// firstNode, shell 0) that are not inside, of squared differences to what readers interpolate: by
// preconditioned gradient descent, which never makes the sum larger.
void fitShells(const FieldSamples& original, std::size_t field, ShellGrids& kept);

// Sides below 65 are baked with twice the nodes along each edge, and then coarsened; from 65 on
// that would cost more than it gains.
BakeOptions finerBake(const BakeOptions& options);

// The field with no shell above `side` (2^k + 1): every second, fourth … node, fitted. A third less
// wrong than nodes baked on that grid.
FieldSamples coarsened(const FieldSamples& fine, std::uint32_t side);

} // namespace penumbra
