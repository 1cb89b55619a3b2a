#include "runtime/ecs/world.h"

#include "runtime/assert.h"
#include "runtime/ecs/destroyed_log.h"
#include "runtime/ecs/observer_table.h"

namespace penumbra::ecs {

World::World()
{
    static_cast<void>(archetypeOf(ComponentMask{}));
#ifndef NDEBUG
    rememberDestroyed(true);
#endif
}

World::~World() = default;

Archetype& World::archetypeOf(const ComponentMask& mask)
{
    Archetype*& archetype = m_byMask[mask];
    if (archetype == nullptr) {
        const auto index = static_cast<uint32_t>(m_archetypes.size());
        archetype = m_archetypes.emplace_back(std::make_unique<Archetype>(index, mask)).get();
    }
    return *archetype;
}

Archetype& World::archetypeOf(const ComponentSet& set)
{
    if (set.slot >= m_bySet.size())
        m_bySet.resize(set.slot + 1);
    Archetype*& archetype = m_bySet[set.slot];
    if (archetype == nullptr)
        archetype = &archetypeOf(set.mask);
    return *archetype;
}

const QueryCache& World::cacheOf(uint32_t querySlot) const
{
    const std::lock_guard lock(m_queryMutex);
    if (querySlot >= m_queries.size())
        m_queries.resize(querySlot + 1);
    std::unique_ptr<QueryCache>& cache = m_queries[querySlot];
    if (!cache)
        cache = std::make_unique<QueryCache>(queryTerms(querySlot));
    cache->extend(m_archetypes);
    return *cache;
}

World::Place World::createIn(const ComponentSet& set)
{
    assertStructural();
    Archetype& archetype = archetypeOf(set);
    const Entity entity = m_entities.allocate();
    const uint32_t row = archetype.append({&entity, 1}, m_stamp);
    EntityRecord& record = m_entities[entity];
    record.archetype = archetype.index();
    record.row = row;
    return {&archetype, row};
}

Archetype& World::createManyIn(const ComponentSet& set, std::span<Entity> out)
{
    assertStructural();
    Archetype& archetype = archetypeOf(set);
    m_entities.reserveMore(out.size());
    for (Entity& entity : out)
        entity = m_entities.allocate();
    uint32_t row = archetype.append(out, m_stamp);
    for (const Entity entity : out) {
        m_entities[entity].archetype = archetype.index();
        m_entities[entity].row = row++;
    }
    return archetype;
}

void World::takeRowOut(Archetype& archetype, uint32_t row)
{
    if (const Entity moved = archetype.removeRow(row, m_stamp); !moved.isNull())
        m_entities[moved].row = row;
}

World::Place World::move(Entity entity, Archetype& to)
{
    const Place from = place(entity);
    const uint32_t row = to.append({&entity, 1}, m_stamp);
    to.copyRow(row, *from.archetype, from.row);
    if (from.archetype->disabled().test(from.row)) [[unlikely]]
        to.setDisabled(row, true, m_stamp);
    takeRowOut(*from.archetype, from.row);
    m_entities[entity].archetype = to.index();
    m_entities[entity].row = row;
    return {&to, row};
}

World::Place World::addSet(Entity entity, const ComponentSet& set)
{
    assertStructural(entity);
    const Place from = place(entity);
    std::vector<Archetype*>& edges = from.archetype->withSet;
    if (set.slot >= edges.size())
        edges.resize(set.slot + 1);
    if (edges[set.slot] == nullptr)
        edges[set.slot] = &archetypeOf(from.archetype->mask() | set.mask);
    if (edges[set.slot] != from.archetype)
        return move(entity, *edges[set.slot]);
    set.mask.forEach([&](ComponentId id) {
        if (const int32_t column = from.archetype->columnOf(id); column >= 0)
            from.archetype->markRow(column, from.row, m_stamp);
    });
    return from;
}

void World::removeSet(Entity entity, const ComponentSet& set)
{
    assertStructural(entity);
    const Place from = place(entity);
    if (m_observers != nullptr) [[unlikely]]
        tellRemoved(entity, set.mask);
    std::vector<Archetype*>& edges = from.archetype->withoutSet;
    if (set.slot >= edges.size())
        edges.resize(set.slot + 1);
    if (edges[set.slot] == nullptr)
        edges[set.slot] = &archetypeOf(from.archetype->mask() - set.mask);
    if (set.mask.test(componentId<Parent>()))
        m_hierarchy.detach(entity);
    if (edges[set.slot] != from.archetype)
        move(entity, *edges[set.slot]);
    if (m_observers != nullptr) [[unlikely]]
        settleObservers();
}

void World::attachOrFail(Entity child, Entity parent)
{
    assertStructural(child);
    static_cast<void>(place(child));
    static_cast<void>(place(parent));
    const bool attached = m_hierarchy.attach(child, parent);
    PENUMBRA_ASSERT(attached, "{} under {} closes a cycle; setParent() tells", describe(child),
                    describe(parent));
}

bool World::setParent(Entity child, Entity parent)
{
    assertStructural(child);
    static_cast<void>(place(child));
    static_cast<void>(place(parent));
    if (m_hierarchy.isWithin(parent, child))
        return false;
    add(child, Parent{parent});
    return true;
}

const Hierarchy& World::hierarchy()
{
    assertOutsideSystems();
    m_hierarchy.refresh();
    return m_hierarchy;
}

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
    for (const Entity entity : entities)
        static_cast<void>(place(entity));
    assertStructural();
    if (isWatched()) [[unlikely]]
        return destroyWatched(entities);
    for (const Entity entity : entities)
        if (alive(entity)) // else it went with its parent
            destroyTree(entity);
}

ComponentMask World::components(Entity entity) const
{
    return place(entity).archetype->mask();
}

void World::trim()
{
    assertStructural();
    for (const auto& archetype : m_archetypes)
        archetype->trim();
}

} // namespace penumbra::ecs
