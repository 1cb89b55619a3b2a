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
    const auto slot = static_cast<uint32_t>(found - all.terms.begin()) + 1;
    if (found == all.terms.end()) {
        PENUMBRA_ASSERT(slot < kMaxQueries, "more than {} kinds of query", kMaxQueries - 1);
        all.terms.push_back(terms);
    }
    return slot;
}

const QueryTerms& queryTerms(uint32_t slot)
{
    QueryRegistry& all = registry();
    const std::lock_guard lock(all.mutex);
    return all.terms[slot - 1];
}

QueryCache::QueryCache(const QueryTerms& terms) : m_terms(terms)
{
    size_t lanes = 0;
    for (const ComponentId id : terms.data)
        lanes += componentInfo(id).laneCount;
    m_walkWords = wordCount(terms.data.size(), lanes);
}

void QueryCache::extend(std::span<Archetype* const> archetypes)
{
    for (; m_seen < archetypes.size(); ++m_seen) { // goes on where the one before threw
        Archetype* archetype = archetypes[m_seen];
        if (!archetype->mask().containsAll(m_terms.with) ||
            archetype->mask().intersects(m_terms.without))
            continue;
        Match match{archetype, {}};
        size_t term = 0;
        for (const ComponentId id : m_terms.data)
            match.columns[term++] = static_cast<int16_t>(archetype->columnOf(id));
        for (const ComponentId id : m_terms.changed)
            match.columns[term++] = static_cast<int16_t>(archetype->columnOf(id));
        // As many walks as matches, whatever throws.
        reserveSparingly(m_matches, m_matches.size() + 1);
        m_walks.resize((m_matches.size() + 1) * m_walkWords);
        Word* const walk = &m_walks[m_matches.size() * m_walkWords];
        walk[kArchetype] = reinterpret_cast<Word>(archetype);
        walk[kShape] = ~Word{0}; // no archetype's
        m_matches.push_back(match);
    }
}

// Threads that do this at once write the same.
void QueryCache::resolve(const Match& match) const
{
    Archetype& archetype = *match.archetype;
    if (archetype.layout() == 0)
        return;
    Word* const walk =
        m_walks.data() + static_cast<size_t>(&match - m_matches.data()) * m_walkWords;
    if (load(walk + kShape) >> 32 == archetype.layout()) // rows came or went, and nothing moved
        return __atomic_store_n(walk + kShape, archetype.shape(), __ATOMIC_RELEASE);
    Word* to = walk + kHeadWords;
    const auto put = [&](const void* pointer) {
        __atomic_store_n(to++, reinterpret_cast<Word>(pointer), __ATOMIC_RELAXED);
    };
    std::byte* const* const columnsAt = archetype.columnsAt(0);
    for (size_t term = 0; term < m_terms.data.size(); ++term) {
        const int16_t column = match.columns[term];
        put(column < 0 ? nullptr : &archetype.allVersion(static_cast<uint32_t>(column)));
        for (uint32_t lane = 0; lane < componentInfo(m_terms.data[term]).laneCount; ++lane)
            put(column < 0 ? nullptr : columnsAt[static_cast<uint32_t>(column) + lane]);
    }
    __atomic_store_n(walk + kShape, archetype.shape(), __ATOMIC_RELEASE);
}

uint32_t QueryCache::rowCount() const
{
    uint32_t rows = 0;
    for (const Match& match : m_matches)
        rows += match.archetype->count();
    return rows;
}

} // namespace penumbra::ecs
