#version 460
// gbuffer: the pixel as a receiver, in the words of ReceiverTexels, and the instance that it belongs to.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/transfer.h"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 visibility0;
layout(location = 3) in vec4 visibility1;
layout(location = 4) in vec4 visibility2;
layout(location = 5) in vec4 visibility3;
layout(location = 6) flat in uint instanceIn;
layout(location = 0) out uvec4 geometry;
layout(location = 1) out uvec4 selfVisibilityOut;
layout(location = 2) out uint instance;

void main()
{
    geometry = uvec4(floatBitsToUint(position), packNormal(normalize(normal)));
    selfVisibilityOut = uvec4(packUnorm4x8(visibility0), packUnorm4x8(visibility1), packUnorm4x8(visibility2),
                              packUnorm4x8(visibility3));
    instance = instanceIn;
}
