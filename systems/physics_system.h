// Rigid bodies and the entities that show them.
#pragma once

#include "runtime/ecs/system_context.h"
#include "systems/components.h"
#include "systems/physics/physics_world.h"

#include <optional>

namespace penumbra {

// Which body of the PhysicsWorld the entity is.  Written by: buildPhysics.  Read by: stepPhysics.
struct PhysicsBody {
    static constexpr std::string_view kName = "PhysicsBody";
    static constexpr bool kTransient = true;
    std::uint64_t id = 0;
};

// A body for every RigidBody, in the order of the query, each with its PhysicsBody; where there
// is a Ground, what is below y = 0 is solid. Nothing: no entity has a RigidBody. Error: an entity
// has no mesh or hangs on another, its mesh makes no shape, or it weighs more than
// 10^6 kg; the message names it.
Result<std::optional<PhysicsWorld>> buildPhysics(ecs::World& world, const AssetStore& assets);

// System: steps the physics by `seconds` and writes the Transform of every PhysicsBody that moved,
// at the blend of the last two steps. A body at rest keeps its Transform untouched, so nothing
// downstream runs for it.
void stepPhysics(const ecs::SystemContext& context, PhysicsWorld& physics, float seconds);

} // namespace penumbra
