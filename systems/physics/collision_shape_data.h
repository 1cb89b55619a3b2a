// Bullet's side of a CollisionShape. Only for the physics folder.
#pragma once

#include "systems/physics/collision_shape.h"

#include <btBulletCollisionCommon.h>

namespace penumbra {

// Bullet wants a body's origin at its mass centre and its axes along the principal axes of inertia:
// `bodySpace`.
struct CollisionShape::Data {
    std::vector<std::unique_ptr<btCollisionShape>> parts; // children first, the shape itself last
    btTransform meshFromBody = btTransform::getIdentity();
    btVector3 inertiaPerMass{0, 0, 0}; // m², about the body's axes
    float volume = 0;                  // m³
    bool staticOnly = false;

    btCollisionShape* shape() const { return parts.back().get(); }
};

inline btVector3 toBullet(vec3 v)
{
    return {v.x, v.y, v.z};
}
inline btQuaternion toBullet(quat q)
{
    return {q.x, q.y, q.z, q.w};
}
inline vec3 toGlm(const btVector3& v)
{
    return {v.x(), v.y(), v.z()};
}
inline quat toGlm(const btQuaternion& q)
{
    return quat(q.w(), q.x(), q.y(), q.z());
}

} // namespace penumbra
