// QueryCache: the archetypes that a query matches, with the columns it wants, in the order in which
// the archetypes were made. The type-erased half of Query; owned by World.
#pragma once

#include "runtime/ecs/archetype.h"

namespace penumbra::ecs {

inline constexpr uint32_t kMaxQueryTerms = 16;

// What a query asks for. One per combination of terms in the program, whatever code asks.
struct QueryTerms {
    ComponentMask with, without;
    std::vector<ComponentId> data; // columns to hand out, in the order of the terms
    std::vector<ComponentId>
        changed; // a row passes if any of them changed; empty: every row passes
};

inline constexpr uint32_t kMaxQueries = 4096; // in a program

// Thread-safe. The slot is dense, below kMaxQueries: worlds keep their caches in an array.
[[nodiscard]] uint32_t registerQuery(const QueryTerms& terms);
[[nodiscard]] const QueryTerms& queryTerms(uint32_t slot);

class QueryCache {
public:
    struct Match {
        Archetype* archetype;
        // Where the columns of the data terms begin, lanes one by one, null if absent: as long as
        // the archetype's layout() is `layout`, which is never 0. Read and written atomically.
        std::byte** firstColumns;
        mutable uint32_t layout;
        std::array<int16_t, kMaxQueryTerms> columns; // data, then changed; -1: absent
    };

    explicit QueryCache(const QueryTerms& terms);

    // Looks at the archetypes that appeared since the last call.
    void extend(std::span<Archetype* const> archetypes);
    // Thread-safe: true if extend() has nothing to add.
    [[nodiscard]] bool isCurrent(size_t archetypeCount) const
    {
        return __atomic_load_n(&m_seen, __ATOMIC_ACQUIRE) == archetypeCount;
    }

    [[nodiscard]] std::span<const Match> matches() const { return m_matches; }
    [[nodiscard]] uint32_t rowCount() const;
    [[nodiscard]] size_t bytes() const
    {
        return m_matches.capacity() * sizeof(Match) +
               m_firstColumns.capacity() * sizeof(std::byte*);
    }

    // True if `firstColumns` hold; the archetype then has one block and no disabled rows.
    [[nodiscard]] static bool isResolved(const Match& match)
    {
        return __atomic_load_n(&match.layout, __ATOMIC_ACQUIRE) == match.archetype->layout();
    }
    // So that they do from now on, if they can. Thread-safe.
    void resolve(const Match& match) const;

private:
    void addMatch(const Match& match);

    const QueryTerms& m_terms;
    std::vector<Match> m_matches;
    uint32_t m_laneCount = 0;               // of all data terms
    std::vector<std::byte*> m_firstColumns; // [match][lane]
    size_t m_seen = 0;
};

} // namespace penumbra::ecs
