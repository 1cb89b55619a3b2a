#include "systems/physics_system.h"

namespace penumbra {

void stepPhysics(const ecs::SystemContext& context, PhysicsWorld& physics, float seconds)
{
    physics.step(seconds);
    context.query<const RigidBody, const Transform>().each(
        [&](ecs::Entity entity, const RigidBody& body, const Transform& old) {
            const Pose pose = physics.interpolated(body.body);
            Transform moved = old;
            moved.position = pose.position;
            moved.rotation =
                vec4(pose.rotation.x, pose.rotation.y, pose.rotation.z, pose.rotation.w);
            if (moved.position != old.position || moved.rotation != old.rotation)
                context.set(entity, moved);
        });
}

} // namespace penumbra
