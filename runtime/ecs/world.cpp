#include "runtime/ecs/world.h"

#include "runtime/assert.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <unordered_map>

namespace penumbra::ecs {

// Queries by slot, in pages that never move: systems look theirs up at once, without the lock.
constexpr uint32_t kQueryPages = 64;
constexpr uint32_t kQueriesPerPage = 64;

struct World::Index {
    std::unordered_map<ComponentMask, Archetype*, ComponentMask::Hash> byMask;
    std::mutex queryMutex;
    std::array<std::atomic<std::atomic<QueryCache*>*>, kQueryPages> queries{};

    ~Index()
    {
        for (const auto& page : queries) {
            for (uint32_t i = 0; page != nullptr && i < kQueriesPerPage; ++i)
                delete page[i].load();
            delete[] page.load();
        }
    }
};

World::World() : m_index(new Index)
{
    static_cast<void>(archetypeOf(ComponentMask{}));
}

World::~World()
{
    for (const Archetype* archetype : m_archetypes)
        delete archetype;
    delete m_index;
}

void World::failStale(Entity entity) const
{
    const bool known = entity.index < m_entities.indexCount();
    PENUMBRA_ASSERT(false, "entity {} is not alive; {}", toString(entity),
                    entity.isNull()       ? "it is the null entity"
                    : entity.isDeferred() ? "it is a command buffer's, real after playback"
                    : known ? fmt::format("index {} is at generation {}", entity.index,
                                          m_entities.generation(entity.index))
                            : fmt::format("the world has {} indices", m_entities.indexCount()));
    std::abort(); // not reached; the assert does not say so to the compiler
}

void World::failMissing(Entity entity, ComponentId id) const
{
    PENUMBRA_ASSERT(false, "entity {} has no {}; it has: {}", toString(entity),
                    componentInfo(id).name, toString(components(entity)));
    std::abort(); // as above
}

void World::failStructural() const
{
    PENUMBRA_ASSERT(!m_inSystems, "structural change in a system: use context.commands()");
    PENUMBRA_ASSERT(m_iterating == 0,
                    "structural change during {} iteration(s): use a CommandBuffer", m_iterating);
    std::abort(); // as above
}

void World::failInSystem()
{
    PENUMBRA_ASSERT(false, "World used inside a system: go through SystemContext");
    std::abort(); // as above
}

void World::failNoSingleton(ComponentId id)
{
    PENUMBRA_ASSERT(false, "no singleton {} in this world", componentInfo(id).name);
    std::abort(); // as above
}

void failBulkCount(std::string_view component, size_t values, size_t entities)
{
    PENUMBRA_ASSERT(false, "{} values of {} for {} entities", values, component, entities);
    std::abort(); // as above
}

Archetype& World::archetypeOf(const ComponentMask& mask)
{
    Archetype*& archetype = m_index->byMask[mask];
    if (archetype == nullptr) {
        m_archetypes.reserve(m_archetypes.size() + 1);
        archetype = new Archetype(static_cast<uint32_t>(m_archetypes.size()), mask);
        m_archetypes.push_back(archetype);
    }
    return *archetype;
}

Archetype& World::findArchetype(const ComponentSet& set)
{
    if (set.slot >= m_bySet.size())
        m_bySet.resize(set.slot + 1);
    return *(m_bySet[set.slot] = &archetypeOf(set.mask));
}

const QueryCache& World::cacheOf(uint32_t querySlot) const
{
    PENUMBRA_ASSERT(querySlot < kQueryPages * kQueriesPerPage, "{} kinds of query", querySlot);
    auto& page = m_index->queries[querySlot / kQueriesPerPage];
    const uint32_t at = querySlot % kQueriesPerPage;
    if (const auto* known = page.load(std::memory_order_acquire))
        if (const QueryCache* cache = known[at].load(std::memory_order_acquire))
            if (cache->isCurrent(m_archetypes.size())) [[likely]]
                return *cache;
    const std::lock_guard lock(m_index->queryMutex);
    if (page == nullptr)
        page = new std::atomic<QueryCache*>[kQueriesPerPage] {};
    std::atomic<QueryCache*>& cache = page[at];
    if (cache == nullptr) {
        auto made = std::make_unique<QueryCache>(queryTerms(querySlot));
        made->extend(m_archetypes);
        cache = made.release();
    }
    cache.load()->extend(m_archetypes);
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
    m_entities.allocateMany(out, archetype.pages, archetype.count());
    archetype.append(out, m_stamp);
}

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
    const uint32_t row = to.append(entity, m_stamp);
    to.moveRow(row, *from.archetype, from.row);
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
    const uint32_t row = to.append(entities, m_stamp);
    to.moveRows(row, from, m_leaving);
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
    assertStructural();
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
    assertStructural();
    const Place from = place(entity);
    Archetype& to = withoutSet(*from.archetype, set);
    if (&to == from.archetype)
        return;
    makeRoom(to, 1);
    if (from.archetype->mask().test(componentId<Parent>()) &&
        !to.mask().test(componentId<Parent>()))
        m_hierarchy.detach(entity);
    move(entity, from, to);
}

// What setting a parent needs, before anything changes: both alive, room for the links.
void World::checkParent(Entity child, Entity parent)
{
    if (!child.isNull())
        static_cast<void>(place(child));
    static_cast<void>(place(parent));
    m_hierarchy.makeRoom(m_entities.indexCount() + size_t{1});
}

void World::attachOrFail(Entity child, Entity parent)
{
    const bool attached = m_hierarchy.attach(child, parent);
    PENUMBRA_ASSERT(attached, "{} under {} closes a cycle; setParent() tells", toString(child),
                    toString(parent));
}

bool World::setParent(Entity child, Entity parent)
{
    assertStructural();
    checkParent(child, parent);
    if (m_hierarchy.isWithin(parent, child))
        return false;
    add(child, Parent{parent});
    return true;
}

const Hierarchy& World::hierarchy()
{
    assertOutsideSystems();
    m_hierarchy.refresh(m_entities);
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
    assertStructural();
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
    m_leaving.reserve(entities.size()); // before anything changes
    for (size_t done = 0; done < entities.size();) {
        if (!alive(entities[done])) { // went with its parent
            ++done;
            continue;
        }
        if (m_hierarchy.contains(entities[done])) {
            destroy(entities[done++]);
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

WorldStatistics World::statistics() const
{
    WorldStatistics all;
    all.entities = count();
    all.archetypes = static_cast<uint32_t>(m_archetypes.size());
    for (const Archetype* archetype : m_archetypes) {
        all.segments += archetype->segmentCount();
        all.valueBytes += archetype->valueBytes();
        all.blockBytes += archetype->blockBytes();
        all.bookBytes += archetype->bookBytes();
    }
    all.bookBytes += sizeof(*this) + sizeof(*m_index) + m_entities.bytes() + m_hierarchy.bytes();
    all.bookBytes += m_archetypes.capacity() * sizeof(Archetype*) +
                     m_bySet.capacity() * sizeof(Archetype*) +
                     (m_singletons.capacity() + m_doomed.capacity()) * sizeof(Entity) +
                     (m_mergeSlots.capacity() + m_leaving.capacity()) * sizeof(uint32_t);
    // A node of the map: key, value, link, hash; and its bucket.
    all.bookBytes += m_index->byMask.size() * (sizeof(ComponentMask) + 3 * sizeof(void*)) +
                     m_index->byMask.bucket_count() * sizeof(void*);
    for (const auto& page : m_index->queries) {
        if (page == nullptr)
            continue;
        all.bookBytes += kQueriesPerPage * sizeof(void*);
        for (uint32_t i = 0; i < kQueriesPerPage; ++i)
            if (const QueryCache* cache = page[i])
                all.bookBytes += sizeof(*cache) + cache->bytes();
    }
    return all;
}

} // namespace penumbra::ecs
