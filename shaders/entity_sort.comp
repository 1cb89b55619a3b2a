#version 460
// entity_sort: one invocation per visible cluster. The occluders and local lights that can matter to any of its
// receivers, near to far.
//   reads   visible [cull.combineGroups[0]], clusters, bounds, instances
//   writes  lists [visible], cull.pairs, cull.dropped
// Drops an occluder or light that is the receiver itself (its self-visibility says more; a light does not light its own
// surface), whose influence ends before the cluster, or whose sphere lies under the horizon of every receiver (Zhou et
// al. 2005 section 4.2). Near and far: shaders/shared/order.h, taken from the cluster's centre, once per cluster where
// the paper sorts per vertex; equal ones keep instance order.
// An insertion sort in private memory: one lane per cluster beats shared memory and barriers on lavapipe 20 times.
#extension GL_GOOGLE_include_directive : require
#include "shaders/scene.glsl"
#include "shaders/shared/order.h"
#include "shaders/shared/visibility.h"

layout(local_size_x = kSortGroup) in;

// Nearest rows so far, and how many there were.
struct Nearest {
    float key[kMaxClusterOccluders];
    uint row[kMaxClusterOccluders];
    uint count, dropped;
};

void insert(inout Nearest near, uint limit, float key, uint row)
{
    uint at = near.count;
    if (near.count == limit) {
        ++near.dropped;
        if (near.key[limit - 1u] <= key)
            return;
        --at;
    } else {
        ++near.count;
    }
    for (; at > 0u && near.key[at - 1u] > key; --at) {
        near.key[at] = near.key[at - 1u];
        near.row[at] = near.row[at - 1u];
    }
    near.key[at] = key;
    near.row[at] = row;
}

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

    Nearest occluders, lights;
    occluders.count = occluders.dropped = lights.count = lights.dropped = 0u;
    for (uint i = 0u; i < frame.instanceCount + frame.lightCount; ++i) {
        const GpuInstance g = loadInstance(i);
        const bool light = i >= frame.instanceCount;
        const vec3 to = g.sphere.xyz - center;
        if (g.grid.w == 0.0 || length(to) - radius > g.grid.w || belowHorizon(to, g.sphere.w, axis, b.vertices.w, radius))
            continue;
        if (light) {
            if (uint(int(g.material1.z)) != cluster.instance + 1u)
                insert(lights, kMaxClusterLights, powerDistance(g.sphere, center), i);
        } else if (i != cluster.instance) {
            insert(occluders, kMaxClusterOccluders, powerDistance(g.sphere, center), i);
        }
    }

    const uint first = slot * kListStride;
    lists[first] = occluders.count;
    lists[first + 1u] = lights.count;
    for (uint i = 0u; i < occluders.count; ++i)
        lists[first + kListOccluders + i] = occluders.row[i];
    uint before = occluders.count; // never more than for the next farther light, so that kernels need one product
    for (uint l = lights.count; l-- > 0u;) {
        const GpuInstance g = loadInstance(lights.row[l]);
        uint certain = 0u, possible = 0u;
        for (uint i = 0u; i < occluders.count; ++i) {
            const bool own = occluders.row[i] + 1u == uint(int(g.material1.z));
            const float weight =
                own ? 0.0 : orderWeightAround(loadInstance(occluders.row[i]).sphere, g.sphere, center, radius);
            possible |= weight > 0.0 ? 1u << i : 0u;
            certain += certain == i && weight == 1.0 ? 1u : 0u;
        }
        before = min(before, certain);
        lists[first + kListLights + 3u * l] = lights.row[l];
        lists[first + kListLights + 3u * l + 1u] = before;
        lists[first + kListLights + 3u * l + 2u] = before < 32u ? possible >> before << before : 0u;
    }
    atomicAdd(cull.pairs, occluders.count);
    if (occluders.dropped + lights.dropped > 0u)
        atomicAdd(cull.dropped, occluders.dropped + lights.dropped);
}
