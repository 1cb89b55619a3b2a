#version 460
// entity_sort: one invocation per visible cluster. The occluders that can matter to any of its receivers, near to far.
//   reads   visible [cull.combineGroups[0]], clusters, bounds, instances
//   writes  lists [visible][count, occluders …], cull.pairs, cull.dropped
// Drops an occluder that is the receiver itself (its self-visibility says more), whose influence ends before the
// cluster, or whose sphere lies under the horizon of every receiver (Zhou et al. 2005 section 4.2). Distances are
// taken from the cluster's centre, once per cluster where the paper sorts per vertex; equal ones keep instance order.
// An insertion sort in private memory: one lane per cluster beats shared memory and barriers on lavapipe 20 times.
#extension GL_GOOGLE_include_directive : require
#include "shaders/scene.glsl"
#include "shaders/shared/visibility.h"

layout(local_size_x = kSortGroup) in;

void main()
{
    const uint slot = gl_GlobalInvocationID.x;
    if (slot >= cull.combineGroups[0])
        return;
    const SceneCluster cluster = clusters[visible[slot]];
    const ClusterBounds b = bounds[cluster.bounds];
    const GpuInstance self = loadInstance(cluster.instance);
    const vec3 center = affine(self.worldFromObject0, self.worldFromObject1, self.worldFromObject2, b.sphere.xyz);
    const float radius = b.sphere.w * self.material1.y;
    const vec3 axis =
        linear(self.worldFromObject0, self.worldFromObject1, self.worldFromObject2, b.vertices.xyz) / self.material1.y;

    float key[kMaxClusterOccluders];
    uint id[kMaxClusterOccluders];
    uint count = 0u, dropped = 0u;
    for (uint i = 0u; i < frame.instanceCount; ++i) {
        const GpuInstance occluder = loadInstance(i);
        const float influence = occluder.grid.w;
        const vec3 to = occluder.sphere.xyz - center;
        const float distance = length(to);
        if (i == cluster.instance || influence == 0.0 || distance - radius > influence)
            continue;
        if (belowHorizon(to, occluder.sphere.w, axis, b.vertices.w, radius))
            continue;
        uint at = min(count, kMaxClusterOccluders);
        if (count == kMaxClusterOccluders) {
            ++dropped;
            if (key[kMaxClusterOccluders - 1u] <= distance)
                continue;
            --at;
        } else {
            ++count;
        }
        for (; at > 0u && key[at - 1u] > distance; --at) {
            key[at] = key[at - 1u];
            id[at] = id[at - 1u];
        }
        key[at] = distance;
        id[at] = i;
    }

    const uint first = slot * kListStride;
    lists[first] = count;
    for (uint i = 0u; i < count; ++i)
        lists[first + 1u + i] = id[i];
    atomicAdd(cull.pairs, count);
    if (dropped > 0u)
        atomicAdd(cull.dropped, dropped);
}
