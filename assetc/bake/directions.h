// The directions that a bake integrates over.
#pragma once

#include "shaders/shared/interop.h"

#include <vector>

namespace penumbra {

// [count] unit vectors, evenly spread (Fibonacci lattice on one half of the sphere, mirrored): the
// second half holds the opposites of the first, in the same order. `count` is even; every direction
// stands for 4 pi / count sr.
std::vector<vec3> bakeDirections(std::uint32_t count);

} // namespace penumbra
