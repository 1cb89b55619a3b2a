#include "runtime/ecs/world_access.h"

#include "runtime/ecs/observer_table.h"
#include "runtime/ecs/world_index.h"

namespace penumbra::ecs {

void WorldAccess::tellCreated(std::span<const Entity> entities)
{
    ObserverTable* const observers = m_world.m_observers;
    if (observers == nullptr)
        return;
    {
        ObserverRun run(*observers, ObservedEvent::add);
        for (const Entity entity : entities) {
            const ComponentMask& mask = m_world.place(entity).archetype->mask();
            run.add(entity, mask, mask);
        }
    }
    observers->settle();
}

void WorldAccess::replace(Contents&& contents, uint64_t version)
{
    std::vector<uint32_t> generations;
    generations.reserve(contents.records.size());
    for (const Contents::Record& record : contents.records)
        generations.push_back(record.generation);
    m_world.dropQueries();
    m_world.m_index->byMask.clear();
    for (const Archetype* archetype : m_world.m_archetypes)
        delete archetype;
    m_world.m_archetypes.clear();
    m_world.m_bySet.clear();
    m_world.m_entities.restore(generations, contents.free, contents.count);
    for (std::unique_ptr<Archetype>& owner : contents.archetypes) {
        m_world.m_archetypes.push_back(owner.get());
        Archetype& archetype = *owner.release();
        m_world.m_index->byMask.emplace(archetype.mask(), &archetype);
        m_world.growRoom(archetype, 0); // pages for its rows
        m_world.setPlaces(archetype, 0);
    }
    m_world.m_hierarchy = std::move(contents.hierarchy);
    m_world.m_singletons = std::move(contents.singletons);
    m_world.m_stamp = {version, version - 1};
    m_world.m_mergeSlots.clear();
    if (m_world.m_destroyed != nullptr)
        m_world.rememberDestroyed(true); // from now on
}

} // namespace penumbra::ecs
