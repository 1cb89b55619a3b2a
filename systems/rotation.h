// Rotations as components and shaders hold them, unit quaternions x, y, z, w, and as GLM computes
// with them.
#pragma once

#include "shaders/shared/interop.h"

#include <glm/gtc/quaternion.hpp>

namespace penumbra {

inline quat toQuat(vec4 q)
{
    return {q.w, q.x, q.y, q.z};
}

inline vec4 toVec4(const quat& q)
{
    return {q.x, q.y, q.z, q.w};
}

} // namespace penumbra
