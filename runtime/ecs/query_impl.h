// The templates of query.h, which includes this file: terms, marks, rows. The walks: query_walk.h.
#pragma once

#include "runtime/ecs/query.h"

namespace penumbra::ecs {

// Counts the walks of a world in debug builds, so that structural changes meanwhile can assert.
class IterationGuard {
public:
#ifdef NDEBUG
    explicit IterationGuard(uint32_t&) {}
#else
    explicit IterationGuard(uint32_t& walks) : m_walks(walks)
    {
        __atomic_fetch_add(&m_walks, 1, __ATOMIC_RELAXED);
    }
    ~IterationGuard()
    {
        __atomic_fetch_sub(&m_walks, 1, __ATOMIC_RELAXED);
    }
    IterationGuard(const IterationGuard&) = delete;
    IterationGuard& operator=(const IterationGuard&) = delete;

private:
    uint32_t& m_walks;
#endif
};

template <class... Terms>
inline constinit uint32_t kKnownQuery = 0; // Query::slot() once found, plus one: as kKnownId

template <class... Terms>
uint32_t Query<Terms...>::slot()
{
    const uint32_t known = __atomic_load_n(&kKnownQuery<Terms...>, __ATOMIC_RELAXED);
    return known != 0 ? known - 1 : findSlot();
}

template <class... Terms>
[[gnu::noinline, gnu::cold]] uint32_t Query<Terms...>::findSlot()
{
    const uint32_t found = [] {
        QueryTerms terms;
        [[maybe_unused]] const auto add = [&]<class Term>() {
            using Traits = TermTraits<Term>;
            if constexpr (Traits::kKind != TermKind::option) {
                const ComponentId id = componentId<typename Traits::Component>();
                if (Traits::kKind == TermKind::without)
                    terms.without.set(id);
                else if (!Traits::kOptional)
                    terms.with.set(id);
                if (Traits::kKind == TermKind::data)
                    terms.data.push_back(id);
                if (Traits::kKind == TermKind::changed)
                    terms.changed.push_back(id);
            }
        };
        (add.template operator()<Terms>(), ...);
        return registerQuery(terms);
    }();
    __atomic_store_n(&kKnownQuery<Terms...>, found + 1, __ATOMIC_RELAXED);
    return found;
}

template <class... Terms>
uint32_t Query<Terms...>::count() const
{
    uint32_t rows = m_cache->rowCount();
    for (const Match& match : m_cache->matches())
        rows -= kSeesDisabled ? 0 : match.archetype->disabled().count();
    return rows;
}

template <class... Terms>
uint32_t Query<Terms...>::segmentCount() const
{
    uint32_t segments = 0;
    for (const Match& match : m_cache->matches()) {
        if (!skips(*match.archetype))
            segments += match.archetype->segmentCount();
        else
            for (uint32_t s = 0; s < match.archetype->segmentCount(); ++s)
                forRunsOf<false>(match, s, [&](const Run&) { ++segments; });
    }
    return segments;
}

template <class... Terms>
uint64_t Query<Terms...>::changedRows(const Match& match, uint32_t segment, uint32_t word) const
{
    uint64_t rows = 0;
    for (size_t i = 0; i < kChangedCount; ++i)
        rows |= match.archetype->changedRows(match.columns[kDataCount + i], segment, word, m_since);
    return rows;
}

template <class... Terms>
bool Query<Terms...>::segmentPasses(const Match& match, uint32_t segment) const
{
    bool passes = kChangedCount == 0;
    for (size_t i = 0; i < kChangedCount; ++i)
        passes |= match.archetype->version(match.columns[kDataCount + i], segment) > m_since;
    return passes;
}

// False if no segment passes: most worlds hold still for the most part.
template <class... Terms>
bool Query<Terms...>::archetypePasses(const Match& match) const
{
    bool passes = kChangedCount == 0;
    for (size_t i = 0; i < kChangedCount; ++i)
        passes |= match.archetype->version(match.columns[kDataCount + i]) > m_since;
    return passes;
}

template <class... Terms>
void Query<Terms...>::mark(const Match& match, uint32_t segment, uint32_t row, uint32_t count) const
{
    [&]<size_t... k>(std::index_sequence<k...>)
    {
        [[maybe_unused]] const auto markTerm = [&](bool writes, int16_t column) {
            if (writes && column >= 0)
                match.archetype->markRows(column, segment, row, count, m_stamp);
        };
        (markTerm(!std::is_const_v<typename Argument<k>::Access>, match.columns[k]), ...);
    }
    (DataIndices());
}

template <class... Terms>
template <size_t k>
auto Query<Terms...>::lanePointers(const Match& match, uint32_t row)
{
    using Element = typename Argument<k>::Element;
    return [&]<size_t... kLane>(std::index_sequence<kLane...>)
    {
        const int32_t column = match.columns[k];
        const auto pointer = [&](size_t lane) {
            std::byte* at = column < 0 ? nullptr : match.archetype->at(column + lane, row);
            return reinterpret_cast<Element*>(at);
        };
        return std::make_tuple(pointer(kLane)...);
    }
    (std::make_index_sequence<Argument<k>::kPointers>());
}

template <class... Terms>
template <size_t... k>
auto Query<Terms...>::columnPointers([[maybe_unused]] const Match& match,
                                     [[maybe_unused]] uint32_t row, std::index_sequence<k...>)
{
    return std::tuple_cat(lanePointers<k>(match, row)...);
}

template <class... Terms>
template <size_t k>
constexpr size_t Query<Terms...>::firstPointer()
{
    return []<size_t... i>(std::index_sequence<i...>)
    {
        return (size_t{0} + ... + Argument<i>::kPointers);
    }
    (std::make_index_sequence<k>());
}

template <class... Terms>
template <class F, class Columns, size_t... k>
void Query<Terms...>::callRow(F& f, [[maybe_unused]] const Entity* entities,
                              [[maybe_unused]] size_t row, const Columns& columns,
                              std::index_sequence<k...>)
{
    Arguments arguments;
    (std::get<k>(arguments).template load<firstPointer<k>()>(columns, row), ...);
    if constexpr (std::is_invocable_v<F&, Entity, decltype(std::get<k>(arguments).get())...>)
        f(entities[row], std::get<k>(arguments).get()...);
    else
        f(std::get<k>(arguments).get()...);
    (std::get<k>(arguments).template store<firstPointer<k>()>(columns, row), ...);
}

// Its own function because the compiler trusts __restrict on parameters alone: without it, loops
// over more than a few columns do not vectorise.
template <class... Terms>
template <class F, class... Elements>
void Query<Terms...>::callRows(F& f, const Entity* entities, size_t count,
                               Elements* __restrict... columns)
{
    const std::tuple<Elements*...> all(columns...);
    for (size_t row = 0; row < count; ++row)
        callRow(f, entities, row, all, DataIndices());
}

template <class... Terms>
template <class F>
void Query<Terms...>::callRun(F& f, const Match& match, uint32_t row, uint32_t count) const
{
    std::apply(
        [&](auto*... columns) {
            callRows(f, match.archetype->entities().data() + row, count, columns...);
        },
        columnPointers(match, row, DataIndices()));
}

template <class... Terms>
template <class F>
void Query<Terms...>::callMarked(F& f, const Run& run) const
{
    mark(*run.match, run.segment, run.row, run.count);
    callRun(f, *run.match, run.first(), run.count);
}

template <class... Terms>
template <class F>
void Query<Terms...>::callChanged(F& f, const Run& segment) const
{
    const Match& match = *segment.match;
    const Archetype& archetype = *match.archetype;
    const uint32_t first = segment.first();
    const uint32_t rows = segment.count;
    const bool skipsSome = skips(archetype);
    const auto columns = columnPointers(match, first, DataIndices());
    const Entity* entities = archetype.entities().data() + first;
    // First which rows, without a branch per row: where few changed, here and there, wrong guesses
    // would take longer than the work.
    std::array<uint16_t, kPageRows + 3> changed;
    uint32_t count = 0;
    for (uint32_t word = 0; word * 64 < rows; ++word) {
        const uint32_t left = rows - word * 64;
        uint64_t bits = changedRows(match, segment.segment, word);
        bits &= left < 64 ? ~(~uint64_t{0} << left) : ~uint64_t{0};
        if (skipsSome)
            bits &= ~archetype.disabled().word(first + word * 64);
        if (bits == ~uint64_t{0}) {
            for (uint32_t i = 0; i < 64; ++i)
                changed[count++] = static_cast<uint16_t>(word * 64 + i);
            continue;
        }
        do
            for (uint32_t i = 0; i < 3; ++i) { // past the last bit, writes what counts for nothing
                changed[count] = static_cast<uint16_t>(
                    word * 64 + static_cast<uint32_t>(std::countr_zero(bits)));
                count += bits != 0;
                bits &= bits - 1;
            }
        while (bits != 0);
    }
    for (uint32_t i = 0; i < count; ++i) {
        mark(match, segment.segment, changed[i], 1);
        callRow(f, entities, changed[i], columns, DataIndices());
    }
}

template <class... Terms>
template <size_t k, class Columns>
auto Query<Terms...>::segmentArgument(const Columns& columns)
{
    using Access = typename Argument<k>::Access;
    constexpr size_t kFirst = firstPointer<k>();
    if constexpr (Argument<k>::kSplit)
        return [&]<size_t... kLane>(std::index_sequence<kLane...>)
        {
            return Lanes<Access>{{std::get<kFirst + kLane>(columns)...}};
        }
    (std::make_index_sequence<Argument<k>::kPointers>());
    else return static_cast<Access*>(std::get<kFirst>(columns));
}

template <class... Terms>
template <class F>
void Query<Terms...>::callSegment(F& f, const Run& run, uint32_t ordinal) const
{
    mark(*run.match, run.segment, run.row, run.count);
    const auto columns = columnPointers(*run.match, run.first(), DataIndices());
    [&]<size_t... k>(std::index_sequence<k...>)
    {
        f(Segment{run.match->archetype->entities().data() + run.first(), run.count, ordinal},
          segmentArgument<k>(columns)...);
    }
    (DataIndices());
}

} // namespace penumbra::ecs
