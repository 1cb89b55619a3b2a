// Radiance to display: exposure, Khronos PBR Neutral tone mapper (Khronos Group, 2024, the
// published GLSL in our words), sRGB transfer function (IEC 61966-2-1). Used by pass post and for
// the ray-traced pictures, so that both look alike.
#ifndef PENUMBRA_SHADERS_SHARED_TONE_MAP_H
#define PENUMBRA_SHADERS_SHARED_TONE_MAP_H
#include "shaders/shared/interop.h"
PENUMBRA_BEGIN

// Colours up to 0.76 keep hue and saturation; brighter ones are compressed towards white.
PENUMBRA_FN vec3 toneMap(vec3 color)
{
    const float kStart = 0.8f - 0.04f, kDesaturation = 0.15f;
    const float least = min(color.x, min(color.y, color.z));
    const float offset = least < 0.08f ? least - 6.25f * least * least : 0.04f;
    const vec3 c = color - vec3(offset);
    const float peak = max(c.x, max(c.y, c.z));
    if (peak < kStart)
        return c;
    const float room = 1.0f - kStart;
    const float newPeak = 1.0f - room * room / (peak + room - kStart);
    const float grey = 1.0f - 1.0f / (kDesaturation * (peak - newPeak) + 1.0f);
    return mix(c * (newPeak / peak), vec3(newPeak), grey);
}

PENUMBRA_FN float srgbFromLinear(float c)
{
    return c <= 0.0031308f ? 12.92f * c : 1.055f * pow(c, 1.0f / 2.4f) - 0.055f;
}

// [0, 1]^3 for an 8-bit sRGB image. Negative radiance, which a truncated product can give, is
// black.
PENUMBRA_FN vec3 displayColor(vec3 radiance, float exposure)
{
    const vec3 c = clamp(toneMap(max(radiance, vec3(0.0f)) * exposure), vec3(0.0f), vec3(1.0f));
    return vec3(srgbFromLinear(c.x), srgbFromLinear(c.y), srgbFromLinear(c.z));
}

PENUMBRA_END
#endif
