#include "systems/transforms.h"

#include "shaders/shared/instance.h"
#include "systems/rotation.h"

namespace penumbra {

namespace {

// Where each now is, parents first: `moved(entity, WorldTransform)` for what is elsewhere than
// before. `moved` writes at once, since children read it.
template <class Query, class Moved>
void follow(const Query& placed, const ecs::Hierarchy& hierarchy, const Moved& moved)
{
    placed.eachDown(hierarchy, [&](ecs::Entity entity, const WorldTransform& old,
                                   const Transform& local, const WorldTransform* parent) {
        const Transform now = parent ? transformed(parent->at, local) : local;
        if (now.position != old.at.position || now.scale != old.at.scale ||
            now.rotation != old.at.rotation)
            moved(entity, WorldTransform{now});
    });
}

} // namespace

Transform transformed(const Transform& parent, const Transform& child)
{
    const quat rotation =
        glm::normalize(toQuat(parent.rotation) * toQuat(child.rotation)); // no drift
    return {.position = parent.position + rotate(parent.rotation, parent.scale * child.position),
            .scale = parent.scale * child.scale,
            .rotation = toVec4(rotation)};
}

void addWorldTransforms(ecs::World& world)
{
    for (const ecs::Hierarchy::Slot& slot : world.hierarchy().order())
        if (world.has<Transform>(slot.entity))
            world.add(slot.entity, WorldTransform{});
    follow(world.query<const WorldTransform, const Transform, ecs::WithDisabled>(),
           world.hierarchy(),
           [&](ecs::Entity entity, const WorldTransform& now) { world.set(entity, now); });
}

void updateWorldTransforms(const ecs::SystemContext& context)
{
    bool stale = false;
    context.query<ecs::With<WorldTransform>, ecs::Changed<Transform>, ecs::WithDisabled>().each(
        [&](ecs::Entity) { stale = true; });
    if (stale)
        follow(context.query<const WorldTransform, const Transform, ecs::WithDisabled>(),
               context.hierarchy(),
               [&](ecs::Entity entity, const WorldTransform& now) { context.set(entity, now); });
}

const Transform& worldTransform(const ecs::World& world, ecs::Entity entity)
{
    const WorldTransform* const placed = world.tryGet<const WorldTransform>(entity);
    return placed ? placed->at : world.get<const Transform>(entity);
}

} // namespace penumbra
