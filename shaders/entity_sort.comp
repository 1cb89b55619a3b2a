#version 460
// entity_sort: one invocation per visible cluster. The occluders and local lights that can matter to any of its
// receivers, near to far.
//   reads   visible [cull.combineGroups[0]], clusters, bounds, instances
//   writes  lists [visible], cull.pairs, cull.dropped
// Drops an occluder or light that is the receiver itself (its self-visibility says more; a light does not light its own
// surface), whose influence ends before the cluster, or whose sphere lies under the horizon of every receiver (Zhou et
// al. 2005 section 4.2). Near and far: shaders/shared/order.h, taken from the cluster's centre, once per cluster where
// the paper sorts per vertex; equal ones keep instance order. Where there are more than fit, the least important ones are
// left out, and those hardly more important count in part, so that none appears or goes at once.
// An insertion sort in private memory: one lane per cluster beats shared memory and barriers on lavapipe 20 times.
#extension GL_GOOGLE_include_directive : require
#include "shaders/scene.glsl"
#include "shaders/shared/order.h"
#include "shaders/shared/visibility.h"

layout(local_size_x = kSortGroup) in;

layout(constant_id = 3) const bool kLocalLights = true;

// Two lists near to far, occluders and lights, in private arrays: as parameters they would be copied.
struct EntityList {
    uint first, limit, count;
    float least; // the largest importance that was left out
};
float keys[kMaxClusterOccluders + kMaxClusterLights], importances[kMaxClusterOccluders + kMaxClusterLights];
uint rows[kMaxClusterOccluders + kMaxClusterLights];
uint dropped = 0u;

void move(uint from, uint to)
{
    keys[to] = keys[from];
    importances[to] = importances[from];
    rows[to] = rows[from];
}

void insert(inout EntityList list, float key, float importance, uint row)
{
    uint weakest = list.first;
    const uint full = list.count == list.limit ? list.limit : 0u; // lanes without a full list skip the loops
    for (uint i = 1u; i < full; ++i)
        weakest = importances[list.first + i] < importances[weakest] ? list.first + i : weakest;
    if (full > 0u) {
        ++dropped;
        list.least = max(list.least, min(importance, importances[weakest]));
        if (importance <= importances[weakest])
            return;
        --list.count;
        for (; weakest < list.first + list.count; ++weakest)
            move(weakest + 1u, weakest);
    }
    uint at = list.first + list.count++;
    for (; at > list.first && keys[at - 1u] > key; --at)
        move(at - 1u, at);
    keys[at] = key;
    importances[at] = importance;
    rows[at] = row;
}

uint entry(EntityList list, uint i)
{
    return listEntry(rows[list.first + i], entityShare(importances[list.first + i], list.least));
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

    EntityList occluders = EntityList(0u, kMaxClusterOccluders, 0u, 0.0);
    EntityList lights = EntityList(kMaxClusterOccluders, kMaxClusterLights, 0u, 0.0);
    const uint rowCount = frame.instanceCount + (kLocalLights ? frame.lightCount : 0u);
    for (uint i = 0u; i < rowCount; ++i) {
        const GpuInstance g = loadInstance(i);
        const vec3 to = g.sphere.xyz - center;
        if (g.grid.w == 0.0 || length(to) - radius > g.grid.w)
            continue;
        const float highest = highestOver(to, axis, b.vertices.w);
        if ((frame.culls & kCullHorizon) != 0u && belowHorizon(highest, g.sphere.w, radius))
            continue;
        const float key = powerDistance(g.sphere, center);
        const float importance = entityImportance(to, highest, g.sphere.w, g.grid.w, radius);
        if (kLocalLights && i >= frame.instanceCount) {
            if (uint(int(g.material1.z)) != cluster.instance + 1u)
                insert(lights, key, importance * lightStrength(g), i);
        } else if (i != cluster.instance) {
            insert(occluders, key, importance, i);
        }
    }

    const uint first = slot * kListStride;
    lists[first] = occluders.count;
    lists[first + 1u] = lights.count;
    for (uint i = 0u; i < occluders.count; ++i)
        lists[first + kListOccluders + i] = entry(occluders, i);
    uint before = occluders.count; // never more than for the next farther light, so that kernels need one product
    for (uint l = lights.count; l-- > 0u;) {
        const GpuInstance g = loadInstance(rows[lights.first + l]);
        uint certain = 0u, possible = 0u;
        for (uint i = 0u; i < occluders.count; ++i) {
            const bool own = rows[i] + 1u == uint(int(g.material1.z));
            const float weight =
                own ? 0.0 : orderWeightAround(loadInstance(rows[i]).sphere, g.sphere, center, radius);
            possible |= weight > 0.0 ? 1u << i : 0u;
            certain += certain == i && weight == 1.0 ? 1u : 0u;
        }
        before = min(before, certain);
        lists[first + kListLights + 3u * l] = entry(lights, l);
        lists[first + kListLights + 3u * l + 1u] = before;
        lists[first + kListLights + 3u * l + 2u] = before < 32u ? possible >> before << before : 0u;
    }
    atomicAdd(cull.pairs, occluders.count);
    if (dropped > 0u)
        atomicAdd(cull.dropped, dropped);
}
