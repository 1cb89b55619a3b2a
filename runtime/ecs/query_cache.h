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

inline constexpr uint32_t kMaxQueries = 4096; // in a program, slot 0 for none

// Thread-safe. Slots are dense, from 1 on, below kMaxQueries: worlds keep their caches in an array.
[[nodiscard]] uint32_t registerQuery(const QueryTerms& terms);
[[nodiscard]] const QueryTerms& queryTerms(uint32_t slot);

class QueryCache {
public:
    struct Match {
        Archetype* archetype;
        std::array<int16_t, kMaxQueryTerms> columns; // data, then changed; -1: absent
    };

    // All that a walk over a match needs while the archetype keeps its shape(): words side by side,
    // few cache lines, no pointers to follow. Read and written atomically.
    //   archetype | its shape() | for each data term: its allVersion(), where its columns begin,
    //   lane by lane; null if absent
    using Word = uint64_t;
    enum WalkWord : size_t { kArchetype, kShape, kHeadWords };
    static constexpr size_t wordCount(size_t terms, size_t lanes)
    {
        return kHeadWords + terms + lanes;
    }
    template <class T = Word>
    [[nodiscard]] static T load(const Word* word)
    {
        const Word value = __atomic_load_n(word, __ATOMIC_ACQUIRE);
        if constexpr (std::is_pointer_v<T>)
            return reinterpret_cast<T>(value);
        else
            return value;
    }

    explicit QueryCache(const QueryTerms& terms);

    // Looks at the archetypes that appeared since the last call.
    void extend(std::span<Archetype* const> archetypes);
    [[nodiscard]] std::span<const Match> matches() const { return m_matches; }
    [[nodiscard]] uint32_t rowCount() const;
    [[nodiscard]] size_t bytes() const
    {
        return m_matches.capacity() * sizeof(Match) + m_walks.capacity() * sizeof(Word);
    }

    // Of matches()[0 …], side by side, wordCount() each.
    [[nodiscard]] std::span<const Word> walks() const { return m_walks; }
    // Brings the walk of a match up to date, if its archetype has a layout(). Thread-safe.
    void resolve(const Match& match) const;

private:
    mutable std::vector<Word> m_walks;
    size_t m_seen = 0;
    const QueryTerms& m_terms;
    std::vector<Match> m_matches;
    size_t m_walkWords = 0; // of one match
};

// Where a world's queries find their caches, by slot, without a lock.
struct QueryPage {
    static constexpr uint32_t kSlots = 64;
    // Null: not asked for yet, or not since an archetype was made. Threads may fill it in at once;
    // only structural changes, which are alone, empty it.
    std::array<const QueryCache*, kSlots> current{};
};
inline constexpr QueryPage kNoQueries; // until the first of a page is asked for

} // namespace penumbra::ecs
