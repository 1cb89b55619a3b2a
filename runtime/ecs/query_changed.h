// The templates of query.h, which includes this file: rows that Changed<> passes.
#pragma once

#include "runtime/ecs/query_impl.h"

namespace penumbra::ecs {

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
template <bool kByRow>
void Query<Terms...>::markChanged(const Match& match, uint32_t row) const
{
    forWritten(match, [&](auto rowChanges, uint32_t column) {
        if constexpr (rowChanges() == kByRow)
            match.archetype->markRow(column, row, m_stamp);
    });
}

template <class... Terms>
auto Query<Terms...>::changes(const Match& match) const -> Changes
{
    Changes all;
    for (size_t i = 0; i < kChangedCount; ++i)
        all[i] = match.archetype->changedRows(match.columns[kDataCount + i], m_since);
    return all;
}

// Appends the rows of a segment that pass, counted from its start and moved by `offset`, without a
// branch per row: where few changed, here and there, wrong guesses would take longer than the work.
// Writes up to two rows past the new end; returns it.
template <class... Terms>
uint16_t* Query<Terms...>::listChanged(const Match& match, const Changes& changes, uint32_t segment,
                                       uint32_t offset, uint16_t* end) const
{
    const Archetype& archetype = *match.archetype;
    const uint32_t first = segment << archetype.segmentShift();
    const uint32_t rows = std::min(archetype.segmentRows(), archetype.count() - first);
    const bool skipsSome = skips(archetype);
    std::array<uint64_t, kChangedCount> passes; // all bits or none
    for (size_t i = 0; i < kChangedCount; ++i)
        passes[i] = archetype.version(match.columns[kDataCount + i], segment) > m_since
                        ? ~uint64_t{0}
                        : uint64_t{0};
    for (uint32_t word = 0; word * 64 < rows; ++word) {
        const uint32_t left = rows - word * 64;
        uint64_t bits = 0;
        for (size_t i = 0; i < kChangedCount; ++i)
            bits |= passes[i] & changes[i].word(first + word * 64);
        bits &= left < 64 ? ~(~uint64_t{0} << left) : ~uint64_t{0};
        if (skipsSome)
            bits &= ~archetype.disabled().word(first + word * 64);
        const uint32_t start = offset + word * 64;
        if (bits == ~uint64_t{0}) {
            for (uint32_t i = 0; i < 64; ++i)
                *end++ = static_cast<uint16_t>(start + i);
            continue;
        }
        do
            for (uint32_t i = 0; i < 2; ++i) { // past the last bit, writes what counts for nothing
                *end = static_cast<uint16_t>(start + static_cast<uint32_t>(std::countr_zero(bits)));
                end += bits != 0;
                bits &= bits - 1;
            }
        while (bits != 0);
    }
    return end;
}

// First all rows of the segments, up to kListedSegments, which lie in one block, then the calls:
// one loop whose end is hard to guess, not one for each segment.
template <class... Terms>
template <class F>
void Query<Terms...>::callChanged(F& f, const Match& match, const Changes& changes,
                                  uint32_t segment, uint32_t last) const
{
    const Archetype& archetype = *match.archetype;
    const uint32_t shift = archetype.segmentShift();
    const uint32_t first = segment << shift;
    std::array<uint16_t, kListedSegments * kPageRows + 2> changed;
    static_assert(kListedSegments * kPageRows <= UINT16_MAX);
    uint16_t* end = changed.data();
    for (uint32_t s = segment; s <= last; ++s) {
        if (!segmentPasses(match, s))
            continue;
        const uint16_t* const before = end;
        end = listChanged(match, changes, s, (s - segment) << shift, end);
        if (end != before)
            markChanged<false>(match, s << shift); // once; bits of rows one by one
    }
    const auto columns = columnPointers(match, first, FlatIndices());
    const Entity* const entities = archetype.entities().data() + first;
    for (const uint16_t* row = changed.data(); row < end; ++row) {
        markChanged<true>(match, first + *row);
        callRow(f, entities, *row, columns, DataIndices());
    }
}

} // namespace penumbra::ecs
