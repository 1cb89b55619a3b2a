// World: how entities go, and what is owed to those who look.
#include "runtime/ecs/destroyed_log.h"
#include "runtime/ecs/observer_table.h"

#include <algorithm>

namespace penumbra::ecs {

void World::destroyLeaf(Entity entity)
{
    const Place at = place(entity);
    takeRowOut(*at.archetype, at.row);
    m_entities.release(entity);
}

void World::destroy(Entity entity)
{
    assertStructural(entity);
    if (isWatched()) [[unlikely]] {
        static_cast<void>(place(entity));
        return destroyWatched({&entity, 1});
    }
    destroyTree(entity);
}

void World::destroyTree(Entity entity)
{
    if (!m_hierarchy.contains(entity))
        return destroyLeaf(entity);
    m_doomed.clear();
    m_hierarchy.collect(entity, m_doomed);
    while (!m_doomed.empty()) { // from the leaves up: each is a leaf when its turn comes
        m_hierarchy.detach(m_doomed.back());
        destroyLeaf(m_doomed.back());
        m_doomed.pop_back();
    }
}

void World::destroyMany(std::span<const Entity> entities)
{
    assertStructural();
    for (const Entity entity : entities)
        static_cast<void>(place(entity));
    if (isWatched()) [[unlikely]]
        return destroyWatched(entities);
    destroyListed(entities);
}

void World::destroyListed(std::span<const Entity> entities)
{
    m_leaving.reserve(entities.size()); // before anything changes
    for (size_t done = 0; done < entities.size();) {
        if (!alive(entities[done])) { // went with its parent
            ++done;
            continue;
        }
        if (m_hierarchy.contains(entities[done])) {
            destroyTree(entities[done++]);
            continue;
        }
        Archetype& archetype = *place(entities[done]).archetype;
        m_leaving.clear();
        for (; done < entities.size() && alive(entities[done]) &&
               !m_hierarchy.contains(entities[done]);
             ++done) {
            const Place at = m_entities.place(entities[done]);
            if (at.archetype != &archetype)
                break;
            m_leaving.push_back(at.row);
            m_entities.release(entities[done]);
        }
        if (!std::is_sorted(m_leaving.begin(), m_leaving.end()))
            std::sort(m_leaving.begin(), m_leaving.end());
        for (size_t i = m_leaving.size(); i-- > 0;) // see moveRun()
            takeRowOut(archetype, m_leaving[i]);
    }
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
    destroyListed(entities);
    if (m_observers != nullptr)
        m_observers->settle();
}

} // namespace penumbra::ecs
