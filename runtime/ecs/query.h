// Query: walks all rows that have what its terms ask for. Made by World::query() and
// SystemContext::query(), cheap to make and to copy; the archetypes it matches are cached in World,
// which looks for new ones when a query is made: make it where you use it, do not keep it.
//
//   world.query<Position, const Velocity, Without<Frozen>>().each(
//       [&](Position& p, const Velocity& v) { p.x += v.x * dt; });
//
// Disabled entities are skipped, unless WithDisabled is among the terms.
// Order: archetypes in the order they were made, rows from first to last; the same at any number of
// threads. While it runs, structural changes are refused (asserted in debug): record commands.
// Terms are listed in query_terms.h. Lambdas may take Entity as their first parameter.
#pragma once

#include "runtime/ecs/parallel.h"
#include "runtime/ecs/query_cache.h"
#include "runtime/ecs/query_terms.h"

#include <utility>

namespace penumbra::ecs {

class Hierarchy;
struct Parent; // written by World alone, so that the links of Hierarchy follow

// Rows that lie side by side in memory: one segment of one archetype; where rows of it are
// disabled, each run of enabled rows between them is a Segment of its own.
struct Segment {
    const Entity* entities; // [count]
    uint32_t count;
    uint32_t ordinal; // 0, 1, 2 … in the order of iteration: where a reduction puts its part
};

template <class... Terms>
class Query {
    template <class Term>
    using ArgumentIfData =
        std::conditional_t<kIsData<Term>, std::tuple<RowArgument<Term>>, std::tuple<>>;
    using Arguments = decltype(std::tuple_cat(std::declval<ArgumentIfData<Terms>>()...));
    static constexpr bool kSeesDisabled = (std::is_same_v<Terms, WithDisabled> || ...);
    static constexpr size_t kDataCount = std::tuple_size_v<Arguments>;
    static constexpr size_t kChangedCount =
        (0 + ... + (TermTraits<Terms>::kKind == TermKind::changed));

    template <size_t k>
    using Argument = std::tuple_element_t<k, Arguments>;
    using DataIndices = std::make_index_sequence<kDataCount>;
    using Flat = FlatColumns<Arguments>;
    using FlatIndices = std::make_index_sequence<Flat::kCount>;
    static_assert(kDataCount + kChangedCount <= kMaxQueryTerms);
    static_assert((!(kWrites<Terms> &&
                     std::is_same_v<typename TermTraits<Terms>::Component, Parent>)&&...),
                  "Parent is written by World::setParent alone");
    static_assert((!((kIsData<Terms> || TermTraits<Terms>::kKind == TermKind::changed) &&
                     kIsTag<typename TermTraits<Terms>::Component>)&&...),
                  "a tag has no value: With<Tag>");

public:
    static constexpr bool kReadOnly = !(kWrites<Terms> || ...);

    // For World and SystemContext. `iterating` counts the walks in progress.
    Query(const QueryCache& cache, Stamp stamp, uint64_t since, uint32_t& iterating)
        : m_cache(&cache), m_stamp(stamp), m_since(since), m_iterating(&iterating)
    {}

    // The terms, for the cache.
    static uint32_t knownSlot(); // 0 before findSlot()
    static uint32_t findSlot();

    // Changed<> passes what was written after this version (World::version() at the last look).
    [[nodiscard]] Query since(uint64_t version) const
    {
        Query query = *this;
        query.m_since = version;
        return query;
    }

    // f([Entity,] arguments…) for each row. With Changed<>, only rows that changed; mutable
    // arguments then mark just those rows.
    template <class F>
    void each(F&& f) const;

    // f(Segment, columns…) for each segment with rows. With Changed<>, only segments that changed.
    // Pointers of different columns never overlap: declare them __restrict.
    template <class F>
    void eachSegment(F&& f) const;

    // The same on all threads of the arena, one segment per task; f may be called at once for
    // different ones. Inline if there are fewer than kInlineSegments.
    template <class F>
    void parallelEach(F&& f) const;
    template <class F>
    void parallelEachSegment(F&& f) const;
    // 16 KiB take about as long to walk as handing a task to another thread.
    static constexpr uint32_t kInlineSegments = 4;
    // Of a block, whose changed rows are listed at once; that one task takes at most.
    static constexpr uint32_t kListedSegments = 8, kTaskSegments = 8;
    static_assert(kBlockSegments % kListedSegments == 0 && kBlockSegments % kTaskSegments == 0);

    // f(first, arguments…, parent) for each row that is part of the hierarchy, parents before their
    // children: `parent` is the parent's value of the first term, const, null if there is none.
    //   world.query<WorldFromNode, const Local>().eachDown(world.hierarchy(), f)
    // The first term is not split into lanes. Rows that lie in memory as in the hierarchy's order
    // are walked as arrays. Not with Changed<>. Disabled rows are skipped as everywhere; an enabled
    // child of a disabled parent is given the value that the parent has.
    template <class F>
    void eachDown(const Hierarchy& hierarchy, F&& f) const;

    // Rows that each(), and Segments that eachSegment() would hand out; Changed<> is not looked at.
    [[nodiscard]] uint32_t count() const;
    [[nodiscard]] uint32_t segmentCount() const;

private:
    using Match = QueryCache::Match;
    using Word = QueryCache::Word;
    static constexpr size_t kWalkWords = QueryCache::wordCount(kDataCount, Flat::kCount);
    template <size_t p> // where a column begins; its term's allVersion() lies before the first
    static constexpr size_t kLaneWord = QueryCache::kHeadWords + Flat::kPlaces[p].argument + 1 + p;
    struct Run { // rows to visit, within one segment
        const Match* match;
        uint32_t segment;
        uint32_t row; // from the segment's start
        uint32_t count;
        [[nodiscard]] uint32_t first() const
        {
            return (segment << match->archetype->segmentShift()) + row;
        }
    };

    // visit(Run): a segment, or, without its disabled rows, a Run for each stretch between them.
    // Those that look at rows one by one take whole segments (kWhole) and skip by themselves.
    template <bool kWhole, class Visit>
    void forRunsOf(const Match& match, uint32_t segment, Visit&& visit) const;
    template <bool kWhole, class Visit>
    void forRuns(Visit&& visit) const;
    template <class Call>
    static void forTasks(size_t count, Call&& call); // call(i) for each, in parallel or inline
    // Rows of `archetype` are to be skipped.
    [[nodiscard]] static bool skips(const Archetype& archetype)
    {
        return !kSeesDisabled && archetype.disabled().count() != 0;
    }
    [[nodiscard]] bool archetypePasses(const Match& match) const;
    [[nodiscard]] bool segmentPasses(const Match& match, uint32_t segment) const;
    // These rows are about to be written: all; `count` from `row`.
    void markAll(const Match& match) const;
    void mark(const Match& match, uint32_t row, uint32_t count) const;
    using Changes = std::array<ChangedRows, kChangedCount>;
    [[nodiscard]] Changes changes(const Match& match) const; // before the walk's first mark
    uint16_t* listChanged(const Match& match, const Changes& changes, uint32_t segment,
                          uint32_t offset, uint16_t* end) const;
    template <bool kByRow> // in the columns with, or in those without bits by row
    void markChanged(const Match& match, uint32_t row) const;
    template <class Mark>
    static void forWritten(const Match& match, Mark&& mark); // mark(kRowChanges, column)

    // Pointers into all columns of all data terms, flat; as a tuple, to row `row`.
    template <size_t p>
    static auto pointer(const Match& match, std::byte* const* columnsAt, size_t row);
    template <size_t... p>
    static auto columnPointers(const Match& match, uint32_t row, std::index_sequence<p...>);
    template <size_t k, class Columns>
    static auto segmentArgument(const Columns& columns);

    template <class F, class Columns, size_t... k>
    static void callRow(F& f, const Entity* entities, size_t row, const Columns& columns,
                        std::index_sequence<k...>);
    template <class F, class... Elements>
    [[gnu::noinline]] static void callRows(F& f, const Entity* entities, size_t count,
                                           Elements* __restrict... columns);
    template <class F, size_t... p>
    static void callRun(F& f, const Match& match, uint32_t row, uint32_t count,
                        std::index_sequence<p...>);
    template <class F, size_t... k, size_t... p>
    void callFirst(F& f, Archetype& archetype, size_t count, const Word* walk,
                   std::index_sequence<k...>, std::index_sequence<p...>) const; // a resolved one
    template <size_t k>
    void markTerm(Archetype& archetype, const Word* walk) const; // all rows, of a resolved one
    template <class F>
    void callAll(F& f, const Match& match) const; // all rows of any match, marked
    template <class F>
    void callMarked(F& f, const Run& run) const; // marks, then callRun
    template <class F>
    void callChanged(F& f, const Match& match, const Changes& changes, uint32_t segment,
                     uint32_t last) const;
    template <class F>
    void callSegment(F& f, const Run& run, uint32_t ordinal) const;

    const QueryCache* m_cache;
    Stamp m_stamp;
    uint64_t m_since;
    uint32_t* m_iterating;
};

} // namespace penumbra::ecs

#include "runtime/ecs/query_walk.h"
