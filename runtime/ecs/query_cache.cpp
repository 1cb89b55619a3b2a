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

void QueryCache::extend(std::span<Archetype* const> archetypes)
{
    for (size_t seen = m_seen; seen < archetypes.size(); ++seen) {
        Archetype* archetype = archetypes[seen];
        if (!archetype->mask().containsAll(m_terms.with) ||
            archetype->mask().intersects(m_terms.without))
            continue;
        Match match{archetype, {}};
        size_t term = 0;
        for (const ComponentId id : m_terms.data)
            match.columns[term++] = static_cast<int16_t>(archetype->columnOf(id));
        for (const ComponentId id : m_terms.changed)
            match.columns[term++] = static_cast<int16_t>(archetype->columnOf(id));
        m_matches.push_back(match);
    }
    __atomic_store_n(&m_seen, archetypes.size(), __ATOMIC_RELEASE);
}

uint32_t QueryCache::rowCount() const
{
    uint32_t rows = 0;
    for (const Match& match : m_matches)
        rows += match.archetype->count();
    return rows;
}

} // namespace penumbra::ecs
