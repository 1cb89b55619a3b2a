#version 460
// background: what shines on the scene from afar, in the direction of the pixel: the sum of two environment maps, each
// turned and scaled. Maps that are not there have the intensity 0.
#extension GL_GOOGLE_include_directive : require
#include "shaders/scene.glsl"
#include "shaders/shared/environment.h"

layout(set = 0, binding = 20) uniform sampler2D sky0;
layout(set = 0, binding = 21) uniform sampler2D sky1;
layout(location = 0) in vec2 clip;
layout(location = 0) out vec4 color;

vec3 skyRadiance(sampler2D map, vec4 mapFromWorld, vec3 direction)
{
    const float border = 0.5 / float(textureSize(map, 0).y); // the sampler repeats: no ground at the zenith
    const vec2 uv = equirectUv(rotate(mapFromWorld, direction));
    return textureLod(map, vec2(uv.x, clamp(uv.y, border, 1.0 - border)), 0.0).rgb;
}

void main()
{
    const vec4 far = frame.worldFromClip * vec4(clip, 1.0, 1.0);
    const vec3 direction = normalize(far.xyz / far.w - frame.eye.xyz);
    vec3 radiance = frame.skyIntensity[0] * skyRadiance(sky0, frame.skyRotation[0], direction);
    if (frame.skyIntensity[1] != 0.0)
        radiance += frame.skyIntensity[1] * skyRadiance(sky1, frame.skyRotation[1], direction);
    color = vec4(frame.backgroundIntensity * radiance, 1.0);
}
