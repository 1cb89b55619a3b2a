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
inline constinit uint32_t kKnownQuery = 0; // Query::findSlot() once found; 0 before

template <class... Terms>
uint32_t Query<Terms...>::knownSlot()
{
    return __atomic_load_n(&kKnownQuery<Terms...>, __ATOMIC_RELAXED);
}

template <class... Terms>
[[gnu::noinline, gnu::cold]] uint32_t Query<Terms...>::findSlot()
{
    if (const uint32_t known = knownSlot())
        return known;
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
    __atomic_store_n(&kKnownQuery<Terms...>, found, __ATOMIC_RELAXED);
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
template <class Mark>
void Query<Terms...>::forWritten(const Match& match, Mark&& mark)
{
    [&]<size_t... k>(std::index_sequence<k...>)
    {
        [[maybe_unused]] const auto markTerm = [&]<class Argument>(Argument, int16_t column) {
            if (!std::is_const_v<typename Argument::Access> &&
                (!Argument::Traits::kOptional || column >= 0))
                mark(std::bool_constant<ComponentTraits<typename Argument::T>::kRowChanges>(),
                     static_cast<uint32_t>(column));
        };
        (markTerm(Argument<k>(), match.columns[k]), ...);
    }
    (DataIndices());
}

template <class... Terms>
void Query<Terms...>::mark(const Match& match, uint32_t row, uint32_t count) const
{
    forWritten(match, [&](auto, uint32_t column) {
        match.archetype->markRows(column, row, count, m_stamp);
    });
}

template <class... Terms>
void Query<Terms...>::markAll(const Match& match) const
{
    forWritten(match, [&](auto rowChanges, uint32_t column) {
        match.archetype->template markAll<rowChanges()>(column, m_stamp);
    });
}

template <class... Terms>
template <size_t k>
[[gnu::always_inline]] inline void Query<Terms...>::markTerm(Archetype& archetype,
                                                             const Word* walk) const
{
    using Term = Argument<k>;
    if constexpr (!std::is_const_v<typename Term::Access>) {
        auto* const all = QueryCache::load<uint64_t*>(walk + kLaneWord<Flat::first(k)> - 1);
        if (Term::Traits::kOptional && all == nullptr)
            return;
        if constexpr (ComponentTraits<typename Term::T>::kRowChanges)
            archetype.template markAll<true>(
                static_cast<uint32_t>(archetype.columnOf(componentId<typename Term::T>())),
                m_stamp);
        else
            *all = m_stamp.version;
    }
}

template <class... Terms>
template <size_t p>
[[gnu::always_inline]] inline auto Query<Terms...>::pointer(const Match& match,
                                                            std::byte* const* columnsAt, size_t row)
{
    constexpr typename Flat::Place kPlace = Flat::kPlaces[p];
    using Term = Argument<kPlace.argument>;
    const int32_t column = match.columns[kPlace.argument];
    if (Term::Traits::kOptional && column < 0)
        return static_cast<typename Term::Element*>(nullptr);
    return reinterpret_cast<typename Term::Element*>(columnsAt[column + kPlace.lane]) + row;
}

template <class... Terms>
template <size_t... p>
auto Query<Terms...>::columnPointers([[maybe_unused]] const Match& match,
                                     [[maybe_unused]] uint32_t row, std::index_sequence<p...>)
{
    return std::make_tuple(
        pointer<p>(match, match.archetype->columnsAt(row), match.archetype->rowInBlock(row))...);
}

template <class... Terms>
template <class F, class Columns, size_t... k>
void Query<Terms...>::callRow(F& f, [[maybe_unused]] const Entity* entities,
                              [[maybe_unused]] size_t row, const Columns& columns,
                              std::index_sequence<k...>)
{
    Arguments arguments;
    (std::get<k>(arguments).template load<Flat::first(k)>(columns, row), ...);
    if constexpr (std::is_invocable_v<F&, Entity, decltype(std::get<k>(arguments).get())...>)
        f(entities[row], std::get<k>(arguments).get()...);
    else
        f(std::get<k>(arguments).get()...);
    (std::get<k>(arguments).template store<Flat::first(k)>(columns, row), ...);
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
template <class F, size_t... p>
[[gnu::always_inline]] inline void Query<Terms...>::callRun(F& f, const Match& match, uint32_t row,
                                                            uint32_t count,
                                                            std::index_sequence<p...>)
{
    const Archetype& archetype = *match.archetype;
    [[maybe_unused]] std::byte* const* const columnsAt = archetype.columnsAt(row);
    [[maybe_unused]] const size_t inBlock = archetype.rowInBlock(row);
    callRows(f, archetype.entities().data() + row, count, pointer<p>(match, columnsAt, inBlock)...);
}

template <class... Terms>
template <class F, size_t... k, size_t... p>
[[gnu::always_inline]] inline void
Query<Terms...>::callFirst(F& f, Archetype& archetype, size_t count, const Word* walk,
                           std::index_sequence<k...>, std::index_sequence<p...>) const
{
    // All loads before the marks, which the compiler must take for writes to any of this.
    const Entity* const entities = archetype.entities().data();
    const auto call = [&](auto*... elements) {
        (markTerm<k>(archetype, walk), ...);
        callRows(f, entities, count, elements...);
    };
    call(QueryCache::load<typename Argument<Flat::kPlaces[p].argument>::Element*>(walk +
                                                                                  kLaneWord<p>)...);
}

// Whole blocks, not segments: columns run on through a block, and longer loops cost less. Its own
// function so that each() keeps its registers.
template <class... Terms>
template <class F>
[[gnu::noinline]] void Query<Terms...>::callAll(F& f, const Match& match) const
{
    Archetype& archetype = *match.archetype;
    if (skips(archetype)) {
        for (uint32_t s = 0; s < archetype.segmentCount(); ++s)
            forRunsOf<false>(match, s, [&](const Run& run) { callMarked(f, run); });
        return;
    }
    m_cache->resolve(match);
    if (archetype.count() == 0)
        return;
    markAll(match);
    for (uint32_t row = 0; row < archetype.count(); row += archetype.blockRows()) {
        callRun(f, match, row, std::min(archetype.blockRows(), archetype.count() - row),
                FlatIndices());
    }
}

template <class... Terms>
template <class F>
void Query<Terms...>::callMarked(F& f, const Run& run) const
{
    mark(*run.match, run.first(), run.count);
    callRun(f, *run.match, run.first(), run.count, FlatIndices());
}

template <class... Terms>
template <size_t k, class Columns>
auto Query<Terms...>::segmentArgument(const Columns& columns)
{
    using Access = typename Argument<k>::Access;
    constexpr size_t kFirst = Flat::first(k);
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
    mark(*run.match, run.first(), run.count);
    const auto columns = columnPointers(*run.match, run.first(), FlatIndices());
    [&]<size_t... k>(std::index_sequence<k...>)
    {
        f(Segment{run.match->archetype->entities().data() + run.first(), run.count, ordinal},
          segmentArgument<k>(columns)...);
    }
    (DataIndices());
}

} // namespace penumbra::ecs
