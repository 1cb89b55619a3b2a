#version 460
// raster: receivers as triangles, coloured by pass combine. All data come as attributes: on lavapipe that is much cheaper
// than reading buffers in a vertex shader.
#extension GL_GOOGLE_include_directive : require
#include "shaders/scene.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec4 vertexRadiance;
layout(location = 2) in vec4 worldFromObject0; // per instance
layout(location = 3) in vec4 worldFromObject1;
layout(location = 4) in vec4 worldFromObject2;
layout(location = 0) out vec3 radianceOut;

void main()
{
    gl_Position = frame.clipFromWorld * vec4(affine(worldFromObject0, worldFromObject1, worldFromObject2, position), 1.0);
    radianceOut = vertexRadiance.rgb;
}
