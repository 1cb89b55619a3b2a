#include "runtime/ecs/world_index.h"

#include "runtime/assert.h"
#include "runtime/ecs/destroyed_log.h"
#include "runtime/ecs/observer_table.h"

#include <memory>

namespace penumbra::ecs {

World::World() : m_index(new Index)
{
    m_queryPages.fill(&kNoQueries);
    static_cast<void>(archetypeOf(ComponentMask{}));
#ifndef NDEBUG
    rememberDestroyed(true);
#endif
}

World::~World()
{
    for (const Archetype* archetype : m_archetypes)
        delete archetype;
    delete m_index;
    delete m_observers;
    delete m_destroyed;
}

void World::dropQueries()
{
    m_queryPages.fill(&kNoQueries);
    m_index->queryPages = {};
    m_index->queries.clear();
}

Archetype& World::archetypeOf(const ComponentMask& mask)
{
    Archetype*& archetype = m_index->byMask[mask];
    if (archetype == nullptr) {
        m_archetypes.reserve(m_archetypes.size() + 1);
        archetype = new Archetype(static_cast<uint32_t>(m_archetypes.size()), mask);
        m_archetypes.push_back(archetype);
        for (const std::unique_ptr<QueryPage>& page : m_index->queryPages)
            if (page != nullptr)
                page->current.fill(nullptr);
    }
    return *archetype;
}

Archetype& World::findArchetype(const ComponentSet& set)
{
    if (set.slot >= m_bySet.size())
        m_bySet.resize(set.slot + 1);
    return *(m_bySet[set.slot] = &archetypeOf(set.mask));
}

const QueryCache& World::findCache(uint32_t querySlot) const
{
    const std::lock_guard lock(m_index->queryMutex);
    if (querySlot >= m_index->queries.size())
        m_index->queries.resize(querySlot + 1);
    std::unique_ptr<QueryCache>& cache = m_index->queries[querySlot];
    if (cache == nullptr)
        cache = std::make_unique<QueryCache>(queryTerms(querySlot));
    cache->extend(m_archetypes);
    std::unique_ptr<QueryPage>& page = m_index->queryPages[querySlot / QueryPage::kSlots];
    if (page == nullptr)
        page = std::make_unique<QueryPage>();
    __atomic_store_n(&page->current[querySlot % QueryPage::kSlots], cache.get(), __ATOMIC_RELEASE);
    __atomic_store_n(&m_queryPages[querySlot / QueryPage::kSlots], page.get(), __ATOMIC_RELEASE);
    return *cache;
}

// With pages.
void World::growRoom(Archetype& archetype, uint32_t more)
{
    const uint32_t rows = archetype.count() + more;
    archetype.pages.reserve((rows + kPageRows - 1) >> kPageShift);
    while (archetype.pages.size() << kPageShift < rows)
        archetype.pages.push_back(m_entities.addPage(
            &archetype, static_cast<uint32_t>(archetype.pages.size()) << kPageShift));
    archetype.reserve(rows); // last: room is what it says
}

void World::setPlaces(Archetype& archetype, uint32_t row)
{
    for (const Entity entity : archetype.entities().subspan(row)) {
        m_entities.setPlace(entity, archetype.pages[row >> kPageShift], row);
        ++row;
    }
}

World::NewRow World::createOutsideWindow(const ComponentSet& set)
{
    Archetype& archetype = archetypeOf(set);
    makeRoom(archetype, 1);
    m_entities.reserve(1);
    const Entity entity = m_entities.allocate();
    const uint32_t row = archetype.append(entity, m_stamp);
    m_entities.setFirstPlace(entity, archetype.pages[row >> kPageShift], row);
    archetype.openWindow(row, m_stamp);
    return {archetype.columnsAt(row), archetype.rowInBlock(row), entity};
}

Archetype& World::roomFor(const ComponentSet& set, size_t count)
{
    assertStructural();
    Archetype& archetype = archetypeOf(set);
    makeRoom(archetype, static_cast<uint32_t>(count));
    m_entities.reserve(count);
    if (set.mask.test(componentId<Parent>()))
        m_hierarchy.makeRoom(m_entities.indexCount() + count);
    return archetype;
}

void World::appendNew(Archetype& archetype, std::span<Entity> out)
{
    constexpr uint32_t kPart = 1024; // of a page: what is written is read again from the cache
    while (!out.empty()) {
        const uint32_t row = archetype.count();
        const auto part = out.first(std::min<size_t>(out.size(), kPart - row % kPart));
        m_entities.allocateMany(part, archetype.pages[row >> kPageShift], row);
        archetype.append(part, m_stamp);
        out = out.subspan(part.size());
    }
}

// What setting a parent needs, before anything changes: both alive, room for the links.
void World::checkParent(Entity child, Entity parent)
{
    assertStructural(child);
    if (!child.isNull())
        static_cast<void>(place(child));
    static_cast<void>(place(parent));
    m_hierarchy.makeRoom(m_entities.indexCount() + size_t{1});
}

void World::attachOrFail(Entity child, Entity parent)
{
    const bool attached = m_hierarchy.attach(child, parent);
    PENUMBRA_ASSERT(attached, "{} under {} closes a cycle; setParent() tells", describe(child),
                    describe(parent));
}

bool World::setParent(Entity child, Entity parent)
{
    checkParent(child, parent);
    if (m_hierarchy.isWithin(parent, child))
        return false;
    add(child, Parent{parent});
    return true;
}

void World::clearParent(Entity child)
{
    remove<Parent>(child);
}

const Hierarchy& World::hierarchy()
{
    assertOutsideSystems();
    m_hierarchy.refresh(m_entities);
    return m_hierarchy;
}

ComponentMask World::components(Entity entity) const
{
    return place(entity).archetype->mask();
}

void World::trim()
{
    assertStructural();
    for (Archetype* archetype : m_archetypes) {
        archetype->trim();
        std::vector<uint32_t>& pages = archetype->pages;
        for (; (pages.size() << kPageShift) >= archetype->count() + size_t{kPageRows};
             pages.pop_back())
            m_entities.removePage(pages.back());
    }
    for (auto* scratch : {&m_mergeSlots, &m_leaving}) {
        scratch->clear();
        scratch->shrink_to_fit();
    }
}

} // namespace penumbra::ecs
