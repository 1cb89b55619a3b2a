#version 460
#extension GL_EXT_scalar_block_layout : require

layout(location = 0) in vec2 position; // clip space, Y up
layout(push_constant, scalar) uniform Push
{
    vec4 color;
    float depth;
} push;

void main() { gl_Position = vec4(position, push.depth, 1); }
