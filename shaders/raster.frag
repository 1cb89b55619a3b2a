#version 460
// raster: radiance of the receivers, linear RGB in W/(m² sr).
#extension GL_GOOGLE_include_directive : require
#include "shaders/pixel_radiance.glsl"

layout(location = 0) in vec3 radianceIn;
layout(location = 0) out vec4 color;

void main()
{
    const vec3 radiance = receivedRadiance(radianceIn);
    color = vec4(radiance, 1.0);
}
