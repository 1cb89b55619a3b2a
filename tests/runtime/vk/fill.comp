#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require

// v[i] = v[i] * 3 + value: the order of dispatches shows in the result.
layout(local_size_x = 64) in;
layout(buffer_reference, scalar) buffer Values { uint v[]; };
layout(push_constant, scalar) uniform Push
{
    Values values;
    uint value;
    uint count;
} push;

void main()
{
    if (gl_GlobalInvocationID.x < push.count)
        push.values.v[gl_GlobalInvocationID.x] =
            push.values.v[gl_GlobalInvocationID.x] * 3 + push.value;
}
