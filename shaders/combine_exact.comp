#version 460
// combine_exact: one workgroup per visible cluster, kReceivers receivers per invocation.
//   T = transfer of the receiver, its values at the 32 nodes          (shaders/shared/transfer.h)
//   occluder: T = O * T, node by node                                 (triple product)
//   light:    B = sum over nodes of weight * L * T                    (double product; the environment)
// Source: Zhou et al. 2005, Fig. 5; the fast way is findings section 1, kernel J.
// Differs: products at quadrature nodes instead of tripling coefficients, so a chain keeps more than order 4 and is
// commutative; tetrahedral instead of trilinear sampling with weights of 1/256; entities sorted per cluster.
//   reads   visible, clusters, lists, instances, fields, receivers
//   writes  radiance [receiver] linear RGB in W/(m² sr), a = 1
#extension GL_GOOGLE_include_directive : require
#include "shaders/scene.glsl"

layout(constant_id = 0) const uint kReceivers = 4; // per invocation: amortises the loads of an occluder's constants
layout(local_size_x_id = 1) in;                    // kClusterReceivers / kReceivers
layout(constant_id = 2) const float kSelfScale = 1.0;

void main()
{
    const uint lanes = kClusterReceivers / kReceivers;
    const SceneCluster cluster = clusters[texelFetch(visibleTexels, int(gl_WorkGroupID.x)).x];
    const uint list = gl_WorkGroupID.x * kListStride;
    const uint count = texelFetch(listTexels, int(list)).x;

    vec3 position[kReceivers];
    ShNodal transfer[kReceivers];
    const GpuInstance self = loadInstance(cluster.instance);
    const ShRotation worldFromObject = instanceRotation(self);
    [[unroll]] for (uint v = 0u; v < kReceivers; ++v) {
        const int texel = 2 * int(cluster.firstReceiver + gl_LocalInvocationID.x + v * lanes);
        const Receiver receiver = makeReceiver(self, texelFetch(receiverTexels, texel), frame.eye.xyz);
        const Sh4 visibility = selfVisibility(texelFetch(receiverTexels, texel + 1), kSelfScale);
        position[v] = receiver.position;
        transfer[v] = transferNodal(shRotate(visibility, worldFromObject), receiver);
    }

    for (uint i = 0u; i < count; ++i) {
        const uint occluder = texelFetch(listTexels, int(list + 1u + i)).x;
        const FieldEntity entity = instanceField(loadInstance(occluder));
        [[unroll]] for (uint v = 0u; v < kReceivers; ++v) {
            const vec3 p = fieldPoint(entity, position[v]);
            const FieldCell cell = fieldCell(p, entity.grid);
            const FieldTetrahedron t = fieldTetrahedron(cell.fraction, entity.grid);
            const Sh4 steps = fieldBlend(texelFetch(fieldTexels, int(cell.sample0)),
                                         texelFetch(fieldTexels, int(cell.sample0 + t.offset.y)),
                                         texelFetch(fieldTexels, int(cell.sample0 + t.offset.z)),
                                         texelFetch(fieldTexels, int(cell.sample0 + t.offset.w)), t.weight);
            const Sh4 visibility = fieldVisibility(steps, entity.bandScale * (cell.decay * (1.0 / 256.0)));
            transfer[v] = shMultiply(transfer[v], shNodes(shRotate(visibility, entity.rotation)));
        }
    }

    [[unroll]] for (uint v = 0u; v < kReceivers; ++v) {
        vec3 sum = vec3(0.0);
        for (int n = 0; n < 32; ++n)
            sum += transfer[v].v[n] * frame.lightNodes[n].rgb;
        radiance[cluster.firstRadiance + gl_LocalInvocationID.x + v * lanes] = vec4(self.material.rgb * sum, 1.0);
    }
}
