#version 460
// raster_surface: as raster.vert, with texture coordinates and vertex colours.
#extension GL_GOOGLE_include_directive : require
#include "shaders/scene.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec4 vertexRadiance;
layout(location = 2) in vec4 worldFromObject0; // per instance
layout(location = 3) in vec4 worldFromObject1;
layout(location = 4) in vec4 worldFromObject2;
layout(location = 5) in vec2 baseColorUv;
layout(location = 6) in vec2 emissiveUv;
layout(location = 7) in vec4 vertexColor;
layout(location = 0) out vec3 radianceOut;
layout(location = 1) out vec4 uvsOut;
layout(location = 2) out vec4 vertexColorOut;

void main()
{
    gl_Position = frame.clipFromWorld * vec4(affine(worldFromObject0, worldFromObject1, worldFromObject2, position), 1.0);
    radianceOut = vertexRadiance.rgb;
    uvsOut = vec4(baseColorUv, emissiveUv);
    vertexColorOut = vertexColor;
}
