#include "runtime/ecs/query_cache.h"

#include "runtime/assert.h"

#include <algorithm>
#include <deque>
#include <mutex>

namespace penumbra::ecs {

namespace {

struct QueryRegistry {
    std::mutex mutex;
    std::deque<QueryTerms> terms; // addresses stay
};

QueryRegistry& registry()
{
    static QueryRegistry instance;
    return instance;
}

} // namespace

uint32_t registerQuery(const QueryTerms& terms)
{
    QueryRegistry& all = registry();
    const std::lock_guard lock(all.mutex);
    const auto found = std::find_if(all.terms.begin(), all.terms.end(), [&](const QueryTerms& t) {
        return t.with == terms.with && t.without == terms.without && t.data == terms.data &&
               t.changed == terms.changed;
    });
    const auto slot = static_cast<uint32_t>(found - all.terms.begin());
    if (found == all.terms.end()) {
        PENUMBRA_ASSERT(slot < kMaxQueries, "more than {} kinds of query", kMaxQueries);
        all.terms.push_back(terms);
    }
    return slot;
}

const QueryTerms& queryTerms(uint32_t slot)
{
    QueryRegistry& all = registry();
    const std::lock_guard lock(all.mutex);
    return all.terms[slot];
}

QueryCache::QueryCache(const QueryTerms& terms) : m_terms(terms)
{
    for (const ComponentId id : terms.data)
        m_laneCount += componentInfo(id).laneCount;
}

void QueryCache::extend(std::span<Archetype* const> archetypes)
{
    for (size_t seen = m_seen; seen < archetypes.size(); ++seen) {
        Archetype* archetype = archetypes[seen];
        if (!archetype->mask().containsAll(m_terms.with) ||
            archetype->mask().intersects(m_terms.without))
            continue;
        Match match{archetype, nullptr, kNone, {}};
        size_t term = 0;
        for (const ComponentId id : m_terms.data)
            match.columns[term++] = static_cast<int16_t>(archetype->columnOf(id));
        for (const ComponentId id : m_terms.changed)
            match.columns[term++] = static_cast<int16_t>(archetype->columnOf(id));
        addMatch(match);
        __atomic_store_n(&m_seen, seen + 1, __ATOMIC_RELEASE); // if the next one throws
    }
    __atomic_store_n(&m_seen, archetypes.size(), __ATOMIC_RELEASE);
}

void QueryCache::addMatch(const Match& match)
{
    m_firstColumns.resize((m_matches.size() + 1) * m_laneCount); // may move
    for (size_t i = 0; i < m_matches.size(); ++i)
        m_matches[i].firstColumns = m_firstColumns.data() + i * m_laneCount;
    m_matches.push_back(match);
    m_matches.back().firstColumns = m_firstColumns.data() + (m_matches.size() - 1) * m_laneCount;
}

// Threads that do this at once write the same.
void QueryCache::resolve(const Match& match) const
{
    const uint32_t layout = match.archetype->layout();
    if (layout == 0)
        return;
    std::byte* const* const columnsAt = match.archetype->columnsAt(0);
    std::byte** to = match.firstColumns;
    for (size_t term = 0; term < m_terms.data.size(); ++term) {
        const int16_t column = match.columns[term];
        for (uint32_t lane = 0; lane < componentInfo(m_terms.data[term]).laneCount; ++lane)
            __atomic_store_n(to++, column < 0 ? nullptr : columnsAt[column + lane],
                             __ATOMIC_RELAXED);
    }
    __atomic_store_n(&match.layout, layout, __ATOMIC_RELEASE);
}

uint32_t QueryCache::rowCount() const
{
    uint32_t rows = 0;
    for (const Match& match : m_matches)
        rows += match.archetype->count();
    return rows;
}

} // namespace penumbra::ecs
