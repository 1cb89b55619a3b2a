#version 460
// gbuffer: receivers as triangles; what is interpolated between them stays in object space.
#extension GL_GOOGLE_include_directive : require
#include "shaders/scene.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in uint normal; // packNormal
layout(location = 2) in vec4 worldFromObject0; // per instance
layout(location = 3) in vec4 worldFromObject1;
layout(location = 4) in vec4 worldFromObject2;
layout(location = 5) in vec4 visibility0; // bytes / 255 of the self-visibility
layout(location = 6) in vec4 visibility1;
layout(location = 7) in vec4 visibility2;
layout(location = 8) in vec4 visibility3;
layout(location = 0) out vec3 positionOut;
layout(location = 1) out vec3 normalOut;
layout(location = 2) out vec4 visibilityOut0;
layout(location = 3) out vec4 visibilityOut1;
layout(location = 4) out vec4 visibilityOut2;
layout(location = 5) out vec4 visibilityOut3;
layout(location = 6) flat out uint instanceOut;

void main()
{
    gl_Position = frame.clipFromWorld * vec4(affine(worldFromObject0, worldFromObject1, worldFromObject2, position), 1.0);
    positionOut = position;
    normalOut = unpackNormal(normal);
    visibilityOut0 = visibility0;
    visibilityOut1 = visibility1;
    visibilityOut2 = visibility2;
    visibilityOut3 = visibility3;
    instanceOut = gl_InstanceIndex;
}
