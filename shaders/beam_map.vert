#version 460
// beam_map: what casts shadows, as a beam sees it, into the beam's part of the image.
#extension GL_GOOGLE_include_directive : require
#include "shaders/scene.glsl"

layout(push_constant) uniform Push { uint beam; };

layout(location = 0) in vec3 position;
layout(location = 1) in vec4 worldFromObject0; // per instance
layout(location = 2) in vec4 worldFromObject1;
layout(location = 3) in vec4 worldFromObject2;

void main()
{
    const vec4 p = vec4(affine(worldFromObject0, worldFromObject1, worldFromObject2, position), 1.0);
    const vec2 uv = vec2(dot(frame.beams[beam].u, p), dot(frame.beams[beam].v, p));
    gl_Position = vec4(2.0 * uv - 1.0, dot(frame.beams[beam].depth, p), 1.0);
}
