#version 460
// background: the environment map in the direction of the pixel.
#extension GL_GOOGLE_include_directive : require
#include "shaders/scene.glsl"
#include "shaders/shared/environment.h"

layout(set = 0, binding = 20) uniform sampler2D environmentMap;
layout(location = 0) in vec2 clip;
layout(location = 0) out vec4 color;

void main()
{
    const vec4 far = frame.worldFromClip * vec4(clip, 1.0, 1.0);
    const vec3 direction = normalize(far.xyz / far.w - frame.eye.xyz);
    color = vec4(frame.backgroundIntensity * textureLod(environmentMap, equirectUv(direction), 0.0).rgb, 1.0);
}
