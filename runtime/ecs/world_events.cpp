// World: telling observers.
#include "runtime/ecs/destroyed_log.h"
#include "runtime/ecs/observer_table.h"

namespace penumbra::ecs {

Observer observe(World& world, ObservedEvent event, ComponentId component,
                 ObserverFunction function)
{
    return ObserverTable::of(world).add(event, component, std::move(function));
}

ObserverTable& ObserverTable::of(World& world)
{
    world.assertOutsideSystems();
    if (world.m_observers == nullptr)
        world.m_observers = new ObserverTable(world);
    return *world.m_observers;
}

void World::tellGiven(std::span<const Entity> entities, const ComponentMask& before,
                      const ComponentMask& given)
{
    m_observers->tell(ObservedEvent::add, given - before, entities);
    m_observers->tell(ObservedEvent::set, given - (given - before), entities);
    m_observers->settle();
}

void World::tellRemoved(std::span<const Entity> entities, const ComponentMask& removed)
{
    const ComponentMask& there = place(entities[0]).archetype->mask();
    m_observers->tell(ObservedEvent::remove, removed - (removed - there), entities);
}

void World::settleObservers()
{
    m_observers->settle();
}

bool World::isTelling() const
{
    return m_observers != nullptr && m_observers->telling();
}

void World::ObserversWait::enter()
{
    m_table->enter();
}

void World::ObserversWait::leave(bool settle)
{
    if (ObserverTable* const table = std::exchange(m_table, nullptr); settle)
        table->leave();
    else
        table->abandon();
}

void World::rememberDestroyed(bool remember)
{
    delete m_destroyed;
    m_destroyed = remember ? new DestroyedLog : nullptr;
}

} // namespace penumbra::ecs
