// The one equirectangular mapping of the project, for C++ and GLSL. World space, +Y up:
//     v = 0 looks up (+Y), v = 1 down (-Y);  u = 1/2 looks along +X, u = 3/4 along +Z, u = 0 and 1
//     along -X.
// So, seen from inside, the picture is upright and not mirrored: whoever looks along +X has +Z on
// the right, as in the picture. Blender (after its Z-up to Y-up export) and three.js map the same
// way. Pixel (x, y) of a w x h map covers u in [x, x + 1] / w, v in [y, y + 1] / h: row 0 is the
// top row.
#ifndef PENUMBRA_SHADERS_SHARED_ENVIRONMENT_H
#define PENUMBRA_SHADERS_SHARED_ENVIRONMENT_H
#include "shaders/shared/interop.h"
#ifdef __cplusplus
namespace penumbra {
inline float environmentAzimuth(vec3 d)
{
    return std::atan2(d.z, d.x);
}
inline float environmentPolar(float y)
{
    return std::acos(y);
}
} // namespace penumbra
#else
float environmentAzimuth(vec3 d)
{
    return atan(d.z, d.x);
}
float environmentPolar(float y)
{
    return acos(y);
}
#endif
PENUMBRA_BEGIN

PENUMBRA_CONST float kEnvironmentPi = 3.14159265358979f;

// The unit direction that (u, v) in [0, 1]^2 looks at.
PENUMBRA_FN vec3 equirectDirection(vec2 uv)
{
    const float azimuth = (2.0f * uv.x - 1.0f) * kEnvironmentPi;
    const float polar = uv.y * kEnvironmentPi;
    const float s = sin(polar);
    return vec3(s * cos(azimuth), cos(polar), s * sin(azimuth));
}

// The inverse; `direction` is unit. At the poles u is 1/2.
PENUMBRA_FN vec2 equirectUv(vec3 direction)
{
    const float azimuth =
        direction.x == 0.0f && direction.z == 0.0f ? 0.0f : environmentAzimuth(direction);
    const float polar = environmentPolar(clamp(direction.y, -1.0f, 1.0f));
    return vec2(0.5f + azimuth / (2.0f * kEnvironmentPi), polar / kEnvironmentPi);
}

PENUMBRA_END
#endif
