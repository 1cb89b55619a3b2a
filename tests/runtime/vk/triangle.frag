#version 460
#extension GL_EXT_scalar_block_layout : require

layout(location = 0) out vec4 target;
layout(push_constant, scalar) uniform Push
{
    vec4 color;
    float depth;
} push;

void main() { target = push.color; }
