// Culling, sorting and both combine kernels on the CPU, compiled from the shaders' own headers: the
// oracle of the GPU tests, and, on one thread with kernel literal, the paper's own way to run
// (device cpu-scalar).
#pragma once

#include "systems/scene_data.h"
#include "systems/sky_lobes.h"
#include "systems/techniques/shadow_fields/kernel.h"

namespace penumbra {

// A local light of a cluster, as kListLights of shaders/shared/instance.h describes it.
struct ClusterLight {
    std::uint32_t entry = 0, before = 0, possible = 0, hiders = 0;
    bool operator==(const ClusterLight&) const = default;
};

// One visible cluster with its occluders and lights, near to far.
struct ClusterEntities {
    std::uint32_t cluster = 0;
    std::vector<std::uint32_t> occluders; // listEntry() of shaders/shared/instance.h
    std::vector<std::uint32_t> hidden;    // likewise: dropped, but named by `hiders`
    std::vector<std::uint32_t> hiders;    // [occluders] bits of places in `occluders` and `hidden`
    std::vector<ClusterLight> lights;
};

// Derived constants of all rows; `dense` for kernel literal.
struct CpuInstances {
    std::vector<GpuInstance> instances;
    std::vector<DenseRotation> dense;
};
CpuInstances updateInstances(const SceneData& scene);

// As passes cluster_cull and entity_sort, in cluster order.
std::vector<ClusterEntities> cullAndSort(const SceneData& scene, const CpuInstances& instances,
                                         const FrameConstants& frame);

// How much an occluder or light counts for a receiver, but for the order of occluder and light.
float entityWeight(const CpuInstances& rows, const ClusterEntities& entities, std::uint32_t entry,
                   std::uint32_t hiders, vec3 position, vec3 normal);

// As passes combine_*: writes the kClusterReceivers entries of the cluster in `radiance`
// [scene.radianceCount]. `sky`: not empty; null: none, as for GpuScene::setSkyLobes.
void combineCluster(Kernel kernel, const SceneData& scene, const CpuInstances& instances,
                    const FrameConstants& frame, const ClusterEntities& cluster,
                    std::span<vec4> radiance, const SkyLobes* sky = nullptr);

} // namespace penumbra
