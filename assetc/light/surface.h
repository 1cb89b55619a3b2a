// How a light's own surface looks: what it emits, as a material that any viewer shows.
#pragma once

#include "assetc/light/picture.h"
#include "assetc/light/spec.h"
#include "assets/mesh_asset.h"

namespace penumbra {

// Makes the mesh one submesh per material and each of them emissive, with `picture`, if any, as
// its texture: at most 256 x 256, its brightest channel white, on the texture coordinates of
// makeShapeMesh. Before the mesh is cleaned. Returns what the texture's values are parts of: 1
// without one.
float paintLight(MeshAsset& mesh, const LightSpec& spec, const LightPicture* picture);

// The emission, once it is known: W/(m² sr).
void setEmission(MeshAsset& mesh, vec3 radiance);

} // namespace penumbra
