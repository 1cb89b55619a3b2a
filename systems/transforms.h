// Where entities are in the world when they hang on others.
#pragma once

#include "runtime/ecs/system_context.h"
#include "systems/components.h"

namespace penumbra {

// Transform to world space, of entities that have a Parent or children; that of all others is in
// world space already.  Written by: addWorldTransforms, updateWorldTransforms.  Read by:
// extractScene, gather, pick.
struct WorldTransform {
    static constexpr std::string_view kName = "WorldTransform";
    static constexpr bool kTransient = true;
    static constexpr bool kRowChanges = true; // as Transform
    Transform at;                             // world
};
static_assert(sizeof(WorldTransform) == 32 && std::is_trivially_copyable_v<WorldTransform>);

// A child's transform in the space of `parent`'s parent.
Transform transformed(const Transform& parent, const Transform& child);

// Gives each entity with Transform and a Parent or children its WorldTransform. A parent without
// Transform is at the origin of the world.
void addWorldTransforms(ecs::World& world);

// System: reads Transform, writes the WorldTransform of what moved. Does nothing while nobody's
// Transform changes.
void updateWorldTransforms(const ecs::SystemContext& context);

// The entity has a Transform.
const Transform& worldTransform(const ecs::World& world, ecs::Entity entity);

} // namespace penumbra
