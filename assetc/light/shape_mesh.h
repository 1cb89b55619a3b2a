// What a light looks like: the visible mesh of an emitter.
#pragma once

#include "assetc/light/spec.h"
#include "assets/mesh_asset.h"

namespace penumbra {

// Positions, unit normals and indices of a sphere, rectangle, disc or spot, as large as the emitter
// (docs/light_spec.md). A spot's mesh is its disc; two-sided ones have triangles on both sides.
MeshAsset makeShapeMesh(const LightSpec& spec);

// Points of an icosahedron whose triangles were split into 4 `splits` times, on the unit sphere.
MeshAsset makeIcosphere(int splits);

} // namespace penumbra
