#version 460
// post: exposure and tone map, linear radiance to 8-bit sRGB. Maths: shaders/shared/tone_map.h.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/tone_map.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D source;
layout(set = 0, binding = 1, rgba8) uniform writeonly image2D target;
layout(push_constant) uniform Push { float exposure; } push;

void main()
{
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(target))))
        return;
    imageStore(target, pixel, vec4(displayColor(texelFetch(source, pixel, 0).rgb, push.exposure), 1.0));
}
