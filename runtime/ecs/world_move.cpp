// World: rows on their way from one archetype to another.
#include "runtime/assert.h"
#include "runtime/ecs/world.h"

#include <algorithm>

namespace penumbra::ecs {

void World::takeRowOut(Archetype& archetype, uint32_t row)
{
    if (const Entity moved = archetype.removeRow(row, m_stamp); !moved.isNull())
        m_entities.setPlace(moved, archetype.pages[row >> kPageShift], row);
}

void World::closeGap(Archetype& archetype, uint32_t row)
{
    if (const Entity moved = archetype.closeGap(row, m_stamp); !moved.isNull())
        m_entities.setPlace(moved, archetype.pages[row >> kPageShift], row);
}

Place World::move(Entity entity, const Place& from, Archetype& to)
{
    makeRoom(to, 1);
    const bool disabled = from.archetype->disabled().test(from.row);
    if (disabled) [[unlikely]]
        to.makeDisabledRoom(1);
    const uint32_t row = to.append(entity, m_stamp);
    to.moveRow(row, *from.archetype, from.row);
    if (disabled) [[unlikely]]
        to.setDisabled(row, true, m_stamp);
    closeGap(*from.archetype, from.row);
    m_entities.setPlace(entity, to.pages[row >> kPageShift], row);
    return {&to, row};
}

size_t World::runLength(std::span<const Entity> entities) const
{
    const Archetype* const first = place(entities[0]).archetype;
    size_t length = 1;
    while (length < entities.size() && place(entities[length]).archetype == first)
        ++length;
    return length;
}

uint32_t World::moveRun(std::span<const Entity> entities, Archetype& from, Archetype& to)
{
    const auto count = static_cast<uint32_t>(entities.size());
    makeRoom(to, count);
    m_leaving.clear();
    m_leaving.reserve(count);
    bool sorted = true;
    for (const Entity entity : entities) {
        const uint32_t row = m_entities.place(entity).row;
        sorted = sorted && (m_leaving.empty() || m_leaving.back() < row);
        m_leaving.push_back(row);
    }
    if (from.disabled().count() != 0) [[unlikely]]
        to.makeDisabledRoom(count);
    const uint32_t row = to.append(entities, m_stamp);
    to.moveRows(row, from, m_leaving);
    for (uint32_t i = 0; i < count && from.disabled().count() != 0; ++i)
        if (from.disabled().test(m_leaving[i]))
            to.setDisabled(row + i, true, m_stamp);
    setPlaces(to, row);
    // From the last row down: the row that fills a gap is then never one that leaves as well.
    if (!sorted)
        std::sort(m_leaving.begin(), m_leaving.end());
    for (size_t i = m_leaving.size(); i-- > 0;) {
        PENUMBRA_ASSERT(i == 0 || m_leaving[i] != m_leaving[i - 1],
                        "an entity is twice in the list");
        closeGap(from, m_leaving[i]);
    }
    return row;
}

Archetype& World::withSet(Archetype& from, const ComponentSet& set)
{
    if (set.slot < from.withSet.size() && from.withSet[set.slot] != nullptr) [[likely]]
        return *from.withSet[set.slot];
    if (set.slot >= from.withSet.size())
        from.withSet.resize(set.slot + 1);
    return *(from.withSet[set.slot] = &archetypeOf(from.mask() | set.mask));
}

Archetype& World::withoutSet(Archetype& from, const ComponentSet& set)
{
    if (set.slot < from.withoutSet.size() && from.withoutSet[set.slot] != nullptr) [[likely]]
        return *from.withoutSet[set.slot];
    if (set.slot >= from.withoutSet.size())
        from.withoutSet.resize(set.slot + 1);
    return *(from.withoutSet[set.slot] = &archetypeOf(from.mask() - set.mask));
}

Place World::addSet(Entity entity, const ComponentSet& set)
{
    assertStructural(entity);
    const Place from = place(entity);
    Archetype& to = withSet(*from.archetype, set);
    if (&to != from.archetype)
        return move(entity, from, to);
    set.mask.forEach([&](ComponentId id) {
        if (const int32_t column = to.columnOf(id); column >= 0)
            to.markRow(static_cast<uint32_t>(column), from.row, m_stamp);
    });
    return from;
}

void World::removeSet(Entity entity, const ComponentSet& set)
{
    assertStructural(entity);
    const Place from = place(entity);
    Archetype& to = withoutSet(*from.archetype, set);
    if (&to == from.archetype)
        return;
    if (m_observers != nullptr) [[unlikely]]
        tellRemoved({&entity, 1}, set.mask);
    makeRoom(to, 1);
    if (from.archetype->mask().test(componentId<Parent>()) &&
        !to.mask().test(componentId<Parent>()))
        m_hierarchy.detach(entity);
    move(entity, from, to);
    if (m_observers != nullptr) [[unlikely]]
        settleObservers();
}

} // namespace penumbra::ecs
