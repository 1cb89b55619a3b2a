#version 460
// combine_literal: the algorithm as the papers write it, one invocation per receiver: the baseline, and the text to read.
//   T = transfer of the receiver in SH, world-aligned
//   occluder: T = TripleProduct(O, T), O trilinearly sampled, dequantised, rotated by a dense matrix
//   light:    B = DoubleProduct(L, T)
// Source: Zhou et al. 2005 Fig. 5; Tamura et al. 2006 Figs. 3, 4. Differs: fields are normalised by g(r) instead of a
// minimum and a step per shell, and entities are sorted per cluster.
//   reads   visible, clusters, lists, instances, denseRotations, fieldSamples, receivers
//   writes  radiance [receiver] linear RGB in W/(m² sr), a = 1
#extension GL_GOOGLE_include_directive : require
#include "shaders/scene.glsl"

layout(local_size_x = kClusterReceivers) in;
layout(constant_id = 2) const float kSelfScale = 1.0;

void main()
{
    const SceneCluster cluster = clusters[visible[gl_WorkGroupID.x]];
    const uint list = gl_WorkGroupID.x * kListStride;
    const uint count = lists[list];

    const GpuInstance self = instances[cluster.instance];
    const ReceiverTexels texels = receivers[cluster.firstReceiver + gl_LocalInvocationID.x];
    const Receiver receiver = makeReceiver(self, texels.geometry, frame.eye.xyz);
    const Sh4 ownVisibility = selfVisibility(texels.selfVisibility, kSelfScale);
    Sh4 transfer = transferSh(shRotateDense(ownVisibility, denseRotations[cluster.instance]), receiver);

    for (uint i = 0u; i < count; ++i) {
        const uint occluder = lists[list + 1u + i];
        const FieldEntity entity = instanceField(instances[occluder]);
        const vec3 p = fieldPoint(entity, receiver.position);
        const FieldCell cell = fieldCell(p, entity.grid);
        Sh4 sum;
        [[unroll]] for (int k = 0; k < 16; ++k)
            sum.c[k] = 0.0;
        [[unroll]] for (uint corner = 0u; corner < 8u; ++corner) {
            const Sh4 steps = fieldSteps(fieldSamples[cell.sample0 + fieldCornerOffset(corner, entity.grid)]);
            const float weight = fieldCornerWeight(corner, cell.fraction);
            [[unroll]] for (int k = 0; k < 16; ++k)
                sum.c[k] += weight * steps.c[k];
        }
        const Sh4 visibility = fieldVisibility(sum, entity.bandScale * cell.decay);
        transfer = shProduct(shRotateDense(visibility, denseRotations[occluder]), transfer);
    }

    vec3 b = vec3(0.0);
    [[unroll]] for (int k = 0; k < 16; ++k)
        b += transfer.c[k] * frame.light[k].rgb;
    radiance[cluster.firstRadiance + gl_LocalInvocationID.x] = vec4(self.material.rgb * b, 1.0);
}
