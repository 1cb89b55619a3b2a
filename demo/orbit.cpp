#include "demo/orbit.h"

#include "systems/rotation.h"

#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace penumbra {

Transform orbitAt(const Orbit& orbit, const Transform& now, double time)
{
    const auto turned = [&](float start, float speed) {
        return static_cast<float>(std::fmod(start + speed * time, 2 * glm::pi<double>()));
    };
    const float angle = turned(orbit.phase, orbit.speed);
    Transform at = now;
    at.position =
        orbit.center + vec3(orbit.radius * std::cos(angle), orbit.bob * std::sin(2 * angle),
                            -orbit.radius * std::sin(angle));
    // +z, turned by an angle about y, is (sin, 0, cos): inwards is a quarter turn behind `angle`.
    const float yaw = orbit.aim > 0 ? angle - glm::half_pi<float>() : turned(0, orbit.spin);
    const quat q = glm::angleAxis(yaw, vec3(0, 1, 0));
    at.rotation = toVec4(q);
    return at;
}

void moveOrbits(const ecs::SystemContext& context, double time)
{
    context.query<const Orbit, Transform>().each([&](const Orbit& orbit, Transform& transform) {
        transform = orbitAt(orbit, transform, time);
    });
}

} // namespace penumbra
