#version 460
// instance_update: one invocation per changed row, an instance or a light. Transform and field -> the constants that every receiver uses.
//   reads   changed, inputs [changedCount], fields [fieldCount]
//   writes  instances [rows] at the changed indices; denseRotations where kernel literal is in use, else skyNodes
#extension GL_GOOGLE_include_directive : require
#include "shaders/scene.glsl"

layout(local_size_x = 16) in;
layout(push_constant) uniform Push { uint changedCount; } push;

void main()
{
    if (gl_GlobalInvocationID.x >= push.changedCount)
        return;
    const uint i = changed[gl_GlobalInvocationID.x];
    const InstanceInput instance = inputs[gl_GlobalInvocationID.x];
    const GpuInstance g = makeInstance(instance, fields[instance.field == kNoField ? 0u : instance.field]);
    instances[i] = g;
    if (frame.literal != 0u)
        denseRotations[i] = denseRotation(instanceRotation(g));
    const mat3 worldFromObject = rotationMatrix(instance.rotation);
    // A bound instead of a branch: lavapipe runs branches that no lane takes.
    const uint nodes = frame.literal == 0u && i < frame.instanceCount ? kSkyNodes : 0u;
    for (uint n = 0u; n < nodes; ++n) {
        const Sh6 basis = shBasis6(worldFromObject * kShNodes[n].xyz);
        vec3 radiance = vec3(0.0);
        [[unroll]] for (uint k = 0u; k < kLightCoefficients; ++k)
            radiance += basis.c[k] * frame.light[k].rgb;
        skyNodes[kSkyNodes * i + n] = vec4(radiance * kShNodes[n].w, 0.0);
    }
}
