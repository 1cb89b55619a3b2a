#version 460
#extension GL_GOOGLE_include_directive : require
#include "tests/runtime/vk/round_trip.h"

// sums[i] = scale * (dot(frame * position, 1) + weight) + texels[texel].w
layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint kScale = 1;
layout(binding = 0) uniform usamplerBuffer texels;
layout(buffer_reference, scalar) readonly buffer Items { RoundTripItem v[]; };
layout(buffer_reference, scalar) writeonly buffer Sums { float v[]; };
layout(push_constant, scalar) uniform Push
{
    Items items;
    Sums sums;
    uint count;
} push;

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= push.count)
        return;
    const RoundTripItem item = push.items.v[i];
    const float sum = dot(item.frame * item.position, vec3(1)) + item.weight;
    push.sums.v[i] = float(kScale) * sum + float(texelFetch(texels, int(item.texel)).w);
}
