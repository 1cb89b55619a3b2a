// A small scene for tests of passes: baked spheres and cubes over a plate, one glossy, under a
// lopsided sky.
#pragma once

#include "assets/environment.h"
#include "systems/frame_constants.h"
#include "systems/scene_data.h"
#include "systems/techniques/shadow_fields/combine_cpu.h"

namespace penumbra {

// Closed meshes with unit normals, clusters and, with `bake`, self-visibility and a field (small:
// 12 shells of 17², 256 directions).
MeshAsset makeSphereAsset(float radius, int rows, bool bake = true);
MeshAsset makeBoxAsset(vec3 halfExtents, int cells, bool bake = true);

// With a field as the asset compiler makes it: 32 shells of 65², 1024 directions.
MeshAsset makeFineSphereAsset(float radius);

// Lights with a field of 14 shells of 17² up to 16 bounding radii.
MeshAsset makeSphereLight(float radius, vec3 radiance);
MeshAsset makeRectangleLight(vec2 size, vec3 radiance);

struct TestScene {
    std::vector<MeshAsset> assets;
    SceneData data;
    Environment environment;
    View view;
    FrameConstants constants;
};
TestScene makeTestScene();

// The same with three lights among the objects: a sphere, the same half inside an object, and a
// rectangle with a surface of its own.
TestScene makeLitTestScene();

// More of both than the lists of a cluster hold.
TestScene makeCrowdedTestScene();

// A large ball with small ones and lights all around: to the floor, it hides those behind it.
TestScene makeBoulderTestScene();

// All clusters with their lists by the CPU twin, whatever the camera sees.
std::vector<ClusterEntities> sortAll(const SceneData& data, const CpuInstances& rows);

// Radiance of every receiver by the CPU twin, whatever the camera sees: [radianceCount].
std::vector<vec4> shadeAll(Kernel kernel, const SceneData& data, const FrameConstants& constants);

} // namespace penumbra
