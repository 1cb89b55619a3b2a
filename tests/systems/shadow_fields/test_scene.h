// A small scene for tests of passes: baked spheres and cubes over a plate, one glossy, under a
// lopsided sky.
#pragma once

#include "assets/environment.h"
#include "systems/frame_constants.h"
#include "systems/scene_data.h"

namespace penumbra {

// Closed meshes with unit normals, clusters and, with `bake`, self-visibility and a field (small:
// 12 shells of 17², 256 directions).
MeshAsset makeSphereAsset(float radius, int rows, bool bake = true);
MeshAsset makeBoxAsset(vec3 halfExtents, int cells, bool bake = true);

struct TestScene {
    std::vector<MeshAsset> assets;
    SceneData data;
    Environment environment;
    View view;
    FrameConstants constants;
};
TestScene makeTestScene();

} // namespace penumbra
