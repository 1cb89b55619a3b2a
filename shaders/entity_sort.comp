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

layout(constant_id = 3) const bool kLocalLights = true;

// Keeps the nearest `limit` rows in order. Private arrays: as parameters they would be copied.
float occluderKey[kMaxClusterOccluders], lightKey[kMaxClusterLights];
uint occluderRow[kMaxClusterOccluders], lightRow[kMaxClusterLights];
uint occluders = 0u, lights = 0u, dropped = 0u;

#define PENUMBRA_INSERT(keys, rows, count, limit, key, row)                                                            \
    {                                                                                                                  \
        uint at = min(count, limit);                                                                                   \
        if (count == limit) {                                                                                          \
            ++dropped;                                                                                                 \
            at = keys[limit - 1u] <= key ? limit : limit - 1u;                                                         \
        } else {                                                                                                       \
            ++count;                                                                                                   \
        }                                                                                                              \
        if (at < limit) {                                                                                              \
            for (; at > 0u && keys[at - 1u] > key; --at) {                                                             \
                keys[at] = keys[at - 1u];                                                                              \
                rows[at] = rows[at - 1u];                                                                              \
            }                                                                                                          \
            keys[at] = key;                                                                                            \
            rows[at] = row;                                                                                            \
        }                                                                                                              \
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

    const uint rows = frame.instanceCount + (kLocalLights ? frame.lightCount : 0u);
    for (uint i = 0u; i < rows; ++i) {
        const GpuInstance g = loadInstance(i);
        const vec3 to = g.sphere.xyz - center;
        if (g.grid.w == 0.0 || length(to) - radius > g.grid.w)
            continue;
        if ((frame.culls & kCullHorizon) != 0u && belowHorizon(to, g.sphere.w, axis, b.vertices.w, radius))
            continue;
        const float key = powerDistance(g.sphere, center);
        if (kLocalLights && i >= frame.instanceCount) {
            if (uint(int(g.material1.z)) != cluster.instance + 1u)
                PENUMBRA_INSERT(lightKey, lightRow, lights, kMaxClusterLights, key, i)
        } else if (i != cluster.instance) {
            PENUMBRA_INSERT(occluderKey, occluderRow, occluders, kMaxClusterOccluders, key, i)
        }
    }

    const uint first = slot * kListStride;
    lists[first] = occluders;
    lists[first + 1u] = lights;
    for (uint i = 0u; i < occluders; ++i)
        lists[first + kListOccluders + i] = occluderRow[i];
    uint before = occluders; // never more than for the next farther light, so that kernels need one product
    for (uint l = lights; l-- > 0u;) {
        const GpuInstance g = loadInstance(lightRow[l]);
        uint certain = 0u, possible = 0u;
        for (uint i = 0u; i < occluders; ++i) {
            const bool own = occluderRow[i] + 1u == uint(int(g.material1.z));
            const float weight =
                own ? 0.0 : orderWeightAround(loadInstance(occluderRow[i]).sphere, g.sphere, center, radius);
            possible |= weight > 0.0 ? 1u << i : 0u;
            certain += certain == i && weight == 1.0 ? 1u : 0u;
        }
        before = min(before, certain);
        lists[first + kListLights + 3u * l] = lightRow[l];
        lists[first + kListLights + 3u * l + 1u] = before;
        lists[first + kListLights + 3u * l + 2u] = before < 32u ? possible >> before << before : 0u;
    }
    atomicAdd(cull.pairs, occluders);
    if (dropped > 0u)
        atomicAdd(cull.dropped, dropped);
}
