// Nodes inside the object: no receiver is there, but its neighbours interpolate towards them.
#pragma once

#include "assetc/bake/field_samples.h"

namespace penumbra {

// Marks the nodes from which every direction is blocked, and gives them what the nodes around
// continue to, layer by layer: a cell that the surface cuts then interpolates the side that can be
// seen, and grids that only the jump to darkness kept fine can be coarse. No shell is left out. A
// field with no free node stays as it is.
void fillInside(FieldSamples& field);

} // namespace penumbra
