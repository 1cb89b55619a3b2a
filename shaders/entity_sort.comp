#version 460
// entity_sort: one invocation per visible cluster. The occluders and local lights that can matter to any of its
// receivers, near to far.
//   reads   visible [cull.combineGroups[0]], clusters, bounds, instances
//   writes  lists [visible], cull.pairs, cull.dropped
// Drops an occluder or light that is the receiver itself (its self-visibility says more; a light does not light its own
// surface), whose influence ends before the cluster, whose sphere lies under the horizon of every receiver, or in the
// shadow that a ball inside an occluder casts from every one (Zhou et al. 2005 section 4.2). Near and far:
// shaders/shared/order.h, taken from the cluster's centre, once per cluster where the paper sorts per vertex; equal ones
// keep instance order. Where there are more than fit, the least important ones are left out, and those hardly more
// important count in part, so that none appears or goes at once.
// An insertion sort in private memory: one lane per cluster beats shared memory and barriers on lavapipe 20 times.
#extension GL_GOOGLE_include_directive : require
#include "shaders/scene.glsl"
#include "shaders/shared/order.h"
#include "shaders/shared/visibility.h"

layout(local_size_x = kSortGroup) in;

layout(constant_id = 3) const bool kLocalLights = true;
layout(constant_id = 4) const bool kHiders = true; // some occluder hides others

// Two lists near to far, occluders and lights, in private arrays: as parameters they would be copied.
struct EntityList {
    uint first, limit, count;
    float least; // the largest importance that was left out
};
float keys[kMaxClusterOccluders + kMaxClusterLights], importances[kMaxClusterOccluders + kMaxClusterLights];
uint rows[kMaxClusterOccluders + kMaxClusterLights];
uint hiders[kMaxClusterOccluders + kMaxClusterLights]; // as bits: occluders that hide it from some receiver
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

struct ClusterPlace {
    vec4 sphere; // world
    vec3 axis;   // of the vertex normals
    float cutoff;
};

// Finds what of a list lies in the shadow of an occluder's inscribed ball: sets `hiders`; returns, as bits, what lies
// there for the whole cluster.
uint findHidden(EntityList list, EntityList occluders, ClusterPlace cluster)
{
    uint balls = 0u;
    for (uint j = 0u; j < occluders.count; ++j)
        balls |= loadInstance(rows[j]).inscribed.w > 0.0 ? 1u << j : 0u;
    for (uint i = 0u; i < list.count; ++i)
        hiders[list.first + i] = 0u;
    uint hidden = 0u;
    for (; balls != 0u; balls &= balls - 1u) {
        const uint j = uint(findLSB(balls));
        const GpuInstance hider = loadInstance(rows[j]);
        const ClusterShadow shadow = clusterShadow(cluster.sphere, hider.inscribed);
        const bool whole =
            entryShare(entry(occluders, j)) == 1.0 &&
            lowestOver(hider.sphere.xyz - cluster.sphere.xyz, cluster.axis, cluster.cutoff) >= cluster.sphere.w;
        for (uint i = 0u; i < list.count; ++i) {
            const GpuInstance g = loadInstance(rows[list.first + i]);
            const ShadowBounds bounds = shadowBounds(shadow, g.sphere.xyz - cluster.sphere.xyz, g.sphere.w);
            // A light's own surface does not hide it.
            const bool apart = rows[list.first + i] != rows[j] && uint(int(g.material1.z)) != rows[j] + 1u;
            hiders[list.first + i] |= apart && bounds.touched ? 1u << j : 0u;
            hidden |= apart && whole && bounds.hidden ? 1u << i : 0u;
        }
    }
    return (frame.culls & kCullHidden) != 0u ? hidden : 0u;
}

// In the list that is written, where the hidden ones come last.
uint placeOf(uint i, uint count, uint hidden)
{
    const uint below = (1u << i) - 1u;
    return (hidden >> i & 1u) == 0u ? uint(bitCount(~hidden & below))
                                    : count - uint(bitCount(hidden)) + uint(bitCount(hidden & below));
}

uint placesOf(uint bits, uint count, uint hidden)
{
    uint places = 0u;
    for (; bits != 0u; bits &= bits - 1u)
        places |= 1u << placeOf(uint(findLSB(bits)), count, hidden);
    return places;
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

    const ClusterPlace here = ClusterPlace(vec4(center, radius), axis, b.vertices.w);
    const uint hidden = kHiders ? findHidden(occluders, occluders, here) : 0u;
    const uint hiddenLights = kHiders ? findHidden(lights, occluders, here) : 0u;
    const uint kept = occluders.count - uint(bitCount(hidden));

    const uint first = slot * kListStride;
    lists[first] = kept;
    lists[first + 1u] = lights.count - uint(bitCount(hiddenLights));
    for (uint i = 0u; i < occluders.count; ++i) {
        const uint place = placeOf(i, occluders.count, hidden);
        lists[first + kListOccluders + place] = entry(occluders, i);
        if (kHiders)
            lists[first + kListHiders + place] = placesOf(hiders[i], occluders.count, hidden);
    }
    uint before = kept; // never more than for the next farther light, so that kernels need one product
    for (uint l = lights.count; l-- > 0u;) {
        const GpuInstance g = loadInstance(rows[lights.first + l]);
        uint certain = 0u, possible = 0u;
        for (uint i = 0u; i < occluders.count; ++i) {
            const uint place = placeOf(i, occluders.count, hidden);
            const bool own = rows[i] + 1u == uint(int(g.material1.z));
            const float weight =
                own || place >= kept ? 0.0 : orderWeightAround(loadInstance(rows[i]).sphere, g.sphere, center, radius);
            possible |= weight > 0.0 ? 1u << place : 0u;
            certain += certain == place && weight == 1.0 ? 1u : 0u;
        }
        before = (hiddenLights >> l & 1u) != 0u ? before : min(before, certain);
        const uint at = first + kListLights + kListLightStride * placeOf(l, lights.count, hiddenLights);
        lists[at] = entry(lights, l);
        lists[at + 1u] = before;
        lists[at + 2u] = before < 32u ? possible >> before << before : 0u;
        if (kHiders)
            lists[at + 3u] = placesOf(hiders[lights.first + l], occluders.count, hidden);
    }
    atomicAdd(cull.pairs, kept);
    if (dropped > 0u)
        atomicAdd(cull.dropped, dropped);
}
