// World: telling observers, and what destroy() owes to those who look.
#include "runtime/ecs/destroyed_log.h"
#include "runtime/ecs/observer_table.h"

namespace penumbra::ecs {

Observer observe(World& world, ObservedEvent event, ComponentId component,
                 ObserverFunction function)
{
    world.assertOutsideSystems();
    if (world.m_observers == nullptr)
        world.m_observers = std::make_unique<ObserverTable>(world);
    return world.m_observers->add(event, component, std::move(function));
}

void World::tellGiven(std::span<const Entity> entities, const ComponentMask& before,
                      const ComponentMask& given)
{
    m_observers->tell(ObservedEvent::add, given - before, entities);
    m_observers->tell(ObservedEvent::set, given - (given - before), entities);
    m_observers->settle();
}

void World::tellRemoved(Entity entity, const ComponentMask& removed)
{
    const ComponentMask& there = place(entity).archetype->mask();
    m_observers->tell(ObservedEvent::remove, removed - (removed - there), {&entity, 1});
}

void World::settleObservers()
{
    m_observers->settle();
}

bool World::isTelling() const
{
    return m_observers != nullptr && m_observers->telling();
}

// All are told of while everything is still in place; then they go.
void World::destroyWatched(std::span<const Entity> entities)
{
    std::vector<Entity> doomed;
    for (const Entity entity : entities)
        m_hierarchy.collect(entity, doomed);
    if (entities.size() > 1) { // one may be below another
        std::vector<bool> listed(m_entities.indexCount());
        std::erase_if(doomed, [&](Entity entity) {
            const bool again = listed[entity.index];
            listed[entity.index] = true;
            return again;
        });
    }
    if (m_destroyed != nullptr)
        for (const Entity entity : doomed)
            m_destroyed->add(entity, components(entity), nameOf(entity));
    if (m_observers != nullptr) {
        ObserverRun run(*m_observers, ObservedEvent::remove, true);
        for (const Entity entity : doomed) {
            const ComponentMask& mask = place(entity).archetype->mask();
            run.add(entity, mask, mask);
        }
    }
    for (const Entity entity : entities)
        if (alive(entity))
            destroyTree(entity);
    if (m_observers != nullptr)
        m_observers->settle();
}

void World::rememberDestroyed(bool remember)
{
    m_destroyed = remember ? std::make_unique<DestroyedLog>() : nullptr;
}

} // namespace penumbra::ecs
