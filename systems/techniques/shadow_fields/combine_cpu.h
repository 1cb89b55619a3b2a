// Culling, sorting and both combine kernels on the CPU, compiled from the shaders' own headers: the
// oracle of the GPU tests, and, on one thread with kernel literal, the paper's own way to run
// (device cpu-scalar).
#pragma once

#include "systems/scene_data.h"
#include "systems/techniques/shadow_fields/kernel.h"

namespace penumbra {

// One visible cluster and its occluders, near to far.
struct ClusterOccluders {
    std::uint32_t cluster = 0;
    std::vector<std::uint32_t> occluders; // instances
};

// Derived constants of all instances; `dense` for kernel literal.
struct CpuInstances {
    std::vector<GpuInstance> instances;
    std::vector<DenseRotation> dense;
};
CpuInstances updateInstances(const SceneData& scene);

// As passes cluster_cull and entity_sort, in cluster order.
std::vector<ClusterOccluders> cullAndSort(const SceneData& scene, const CpuInstances& instances,
                                          const FrameConstants& frame);

// As passes combine_*: writes the kClusterReceivers entries of the cluster in `radiance`
// [scene.radianceCount].
void combineCluster(Kernel kernel, const SceneData& scene, const CpuInstances& instances,
                    const FrameConstants& frame, const ClusterOccluders& cluster,
                    std::span<vec4> radiance);

} // namespace penumbra
