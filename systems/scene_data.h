// A scene as flat arrays, in the order in which CPU and GPU walk them: what GpuScene uploads and
// the CPU kernels read. Fields, receivers, triangles and cluster bounds are stored once per asset,
// whatever the number of instances.
#pragma once

#include "assets/mesh_asset.h"
#include "shaders/shared/instance.h"
#include "shaders/shared/transfer.h"

#include <span>
#include <vector>

namespace penumbra {

struct SceneInstance {
    std::uint32_t mesh = 0; // index of a mesh asset
    vec3 position{0};       // world, metres
    float scale = 1;
    vec4 rotation{0, 0, 0, 1}; // quaternion x, y, z, w
    MeshMaterial material;
    bool occluder = true; // blocks light, if its asset has a field
};

// Where an asset lies in the arrays below.
struct MeshRange {
    std::uint32_t firstReceiver = 0, receiverCount = 0; // count: a multiple of kClusterReceivers
    std::uint32_t vertexCount = 0;
    std::uint32_t firstIndex = 0, indexCount = 0;
    std::uint32_t firstBounds = 0, clusterCount = 0;
    std::uint32_t field = kNoField;
};

struct SceneData {
    std::vector<MeshRange> meshes;
    std::vector<ReceiverTexels>
        receivers; // last cluster of a mesh padded with copies of its last vertex
    std::vector<std::uint32_t> indices; // relative to the mesh's firstReceiver
    std::vector<ClusterBounds> bounds;
    std::vector<FieldInput> fields;  // at least one
    std::vector<uvec4> fieldSamples; // one side per field: its largest

    std::vector<SceneInstance> instances;
    std::vector<SceneCluster> clusters; // [sum over instances of clusterCount]
    std::vector<std::uint32_t>
        firstRadiance; // [instanceCount] of the instance's receivers in the radiance buffer
    std::uint32_t radianceCount = 0;
    std::uint64_t vertexCount = 0, triangleCount = 0; // of all instances, without padding
};

SceneData buildSceneData(std::span<const MeshAsset* const> meshes,
                         std::vector<SceneInstance> instances);

InstanceInput instanceInput(const SceneData& scene, const SceneInstance& instance);

} // namespace penumbra
