// World: which entities are enabled.
#include "runtime/ecs/world.h"

namespace penumbra::ecs {

void World::setEnabled(Entity entity, bool enabled, Reach reach)
{
    assertStructural(entity);
    const auto apply = [&](Entity target) {
        const Place at = place(target);
        at.archetype->setDisabled(at.row, !enabled, m_stamp);
    };
    apply(entity);
    if (reach == Reach::entity)
        return;
    std::vector<Entity> tree;
    m_hierarchy.collect(entity, tree);
    for (const Entity target : tree)
        apply(target);
}

bool World::isEnabled(Entity entity) const
{
    const Place at = place(entity);
    return !at.archetype->disabled().test(at.row);
}

} // namespace penumbra::ecs
