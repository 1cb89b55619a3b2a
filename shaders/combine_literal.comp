#version 460
// combine_literal: the algorithm as the papers write it, one invocation per receiver: the baseline, and the text to read.
//   T = transfer of the receiver in SH, world-aligned
//   occluder:    T = TripleProduct(O, T), O trilinearly sampled, dequantised, rotated by a dense matrix
//   local light: B += DoubleProduct(S, T'), T' of the occluders that stand before the light
//   environment: B += DoubleProduct(L, T)
// Source: Zhou et al. 2005 Fig. 5; Tamura et al. 2006 Figs. 3, 4. Differs: fields are normalised by g(r) instead of a
// minimum and a step per shell, entities are sorted per cluster, those at the edge of a full list count in part, and an
// occluder comes before a light by a weight (shaders/shared/order.h).
//   reads   visible, clusters, lists, instances, denseRotations, fieldSamples, receivers
//   writes  radiance [receiver] linear RGB in W/(m² sr), a = 1
#extension GL_GOOGLE_include_directive : require
#include "shaders/scene.glsl"
#include "shaders/shared/order.h"
#include "shaders/shared/visibility.h"

layout(local_size_x = kClusterReceivers) in;
layout(constant_id = 2) const float kSelfScale = 1.0;
layout(constant_id = 3) const bool kLocalLights = true;
layout(constant_id = 4) const bool kHiders = true; // some occluder hides others

uint listed(uint at) { return lists[gl_WorkGroupID.x * kListStride + at]; }

// Of one channel, in steps of the bytes.
Sh4 sampleField(FieldCell cell, FieldGrid grid, uint channel)
{
    const uint sample0 = cell.sample0 + channel * grid.side * grid.side * grid.shells;
    Sh4 sum;
    [[unroll]] for (int k = 0; k < 16; ++k)
        sum.c[k] = 0.0;
    [[unroll]] for (uint corner = 0u; corner < 8u; ++corner) {
        const Sh4 steps = fieldSteps(fieldSamples[sample0 + fieldCornerOffset(corner, grid)]);
        const float weight = fieldCornerWeight(corner, cell.fraction);
        [[unroll]] for (int k = 0; k < 16; ++k)
            sum.c[k] += weight * steps.c[k];
    }
    return sum;
}

float risen(vec4 sphere, Receiver receiver)
{
    return horizonWeight(receiver.normal, sphere.xyz - receiver.position, sphere.w);
}

// How much an entity counts for the receiver; `hiders`: where in the lists its hiders stand.
float entityWeight(uint entry, uint hiders, Receiver receiver)
{
    const vec4 sphere = instances[entryRow(entry)].sphere;
    float weight = entryShare(entry) * risen(sphere, receiver);
    for (uint bits = kHiders ? listed(hiders) : 0u; bits != 0u; bits &= bits - 1u) {
        const uint hider = listed(kListOccluders + uint(findLSB(bits)));
        const GpuInstance g = instances[entryRow(hider)];
        weight *= unhidden(receiver.position, g.inscribed, sphere, entryShare(hider) * risen(g.sphere, receiver));
    }
    return weight;
}

Sh4 occlude(Sh4 transfer, uint place, Receiver receiver, float order)
{
    const uint entry = listed(kListOccluders + place);
    const uint occluder = entryRow(entry);
    const FieldEntity entity = instanceField(instances[occluder]);
    const FieldCell cell = fieldCell(fieldPoint(entity, receiver.position), entity.grid);
    const float weight = order * entityWeight(entry, kListHiders + place, receiver);
    const Sh4 visibility =
        fieldVisibility(sampleField(cell, entity.grid, 0u), entity.bandScale * (weight * cell.decay));
    return shProduct(shRotateDense(visibility, denseRotations[occluder]), transfer);
}

vec3 lightThrough(Sh4 transfer, uint at, Receiver receiver)
{
    const uint light = entryRow(listed(at));
    const FieldEntity entity = instanceField(instances[light]);
    const FieldCell cell = fieldCell(fieldPoint(entity, receiver.position), entity.grid);
    const float weight = entityWeight(listed(at), at + 3u, receiver);
    vec3 b;
    [[unroll]] for (uint channel = 0u; channel < 3u; ++channel) {
        const Sh4 source =
            fieldDeviation(sampleField(cell, entity.grid, channel), entity.bandScale * (weight * cell.decay));
        b[channel] = shDot(shRotateDense(source, denseRotations[light]), transfer);
    }
    return instances[light].material.rgb * b;
}

void main()
{
    const SceneCluster cluster = clusters[visible[gl_WorkGroupID.x]];
    const GpuInstance self = instances[cluster.instance];
    const ReceiverTexels texels = receivers[cluster.firstReceiver + gl_LocalInvocationID.x];
    const Receiver receiver = makeReceiver(self, texels.geometry, frame.eye.xyz);
    const Sh4 ownVisibility = selfVisibility(texels.selfVisibility, kSelfScale);
    Sh4 transfer = transferSh(shRotateDense(ownVisibility, denseRotations[cluster.instance]), receiver);

    vec3 b = vec3(0.0);
    uint next = 0u;
    if (kLocalLights) {
        const uint lights = listed(1u);
        for (uint l = 0u; l < lights; ++l) {
            const uint at = kListLights + kListLightStride * l;
            const vec4 lightSphere = instances[entryRow(listed(at))].sphere;
            for (const uint before = listed(at + 1u); next < before; ++next)
                transfer = occlude(transfer, next, receiver, 1.0);
            Sh4 through = transfer;
            for (uint bits = listed(at + 2u); bits != 0u; bits &= bits - 1u) {
                const uint place = uint(findLSB(bits));
                const uint occluder = entryRow(listed(kListOccluders + place));
                through = occlude(through, place, receiver,
                                  orderWeight(instances[occluder].sphere, lightSphere, receiver.position));
            }
            b += lightThrough(through, at, receiver);
        }
    }
    for (const uint occluders = listed(0u); next < occluders; ++next)
        transfer = occlude(transfer, next, receiver, 1.0);
    [[unroll]] for (int k = 0; k < 16; ++k)
        b += transfer.c[k] * frame.light[k].rgb;
    radiance[cluster.firstRadiance + gl_LocalInvocationID.x] = vec4(self.material.rgb * b + self.emission.rgb, 1.0);
}
