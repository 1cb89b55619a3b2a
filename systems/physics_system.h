// Rigid bodies and the entities that show them.
#pragma once

#include "runtime/ecs/system_context.h"
#include "systems/components.h"
#include "systems/physics/physics_world.h"

namespace penumbra {

// System: steps the physics by `seconds` and writes the Transform of every RigidBody that moved, at
// the blend of the last two steps. A body at rest keeps its Transform untouched, so nothing
// downstream runs for it.
void stepPhysics(const ecs::SystemContext& context, PhysicsWorld& physics, float seconds);

} // namespace penumbra
