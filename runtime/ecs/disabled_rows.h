// Which rows of an archetype are disabled: a bit per row and a count per segment, so that queries
// know at once where nothing is to be skipped. Holds no memory until a row is disabled.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace penumbra::ecs {

class DisabledRows {
public:
    [[nodiscard]] uint32_t count() const { return m_count; }
    [[nodiscard]] uint32_t count(uint32_t segment) const
    {
        return segment < m_counts.size() ? m_counts[segment] : 0;
    }
    [[nodiscard]] bool test(uint32_t row) const
    {
        return m_count != 0 && ((wordAt(row / 64) >> (row % 64)) & 1) != 0;
    }
    // The bits of up to 64 rows from `row`, which starts a segment or is 64 n rows behind its
    // start.
    [[nodiscard]] uint64_t word(uint32_t row) const { return wordAt(row / 64) >> (row % 64); }

    // f(row, count) for each run of enabled rows in [first, end).
    template <class F>
    void eachEnabledRun(uint32_t first, uint32_t end, F&& f) const
    {
        for (uint32_t row = find(first, end, false); row < end;) {
            const uint32_t stop = find(row, end, true);
            f(row, stop - row);
            row = find(stop, end, false);
        }
    }

    void set(uint32_t row, uint32_t segmentShift, bool disabled);
    // set() of the first `rows` rows then does not allocate.
    void makeRoom(uint32_t rows, uint32_t segmentShift);
    // Row `last` takes the place of `row`, as in Archetype::removeRow().
    void removeRow(uint32_t row, uint32_t last, uint32_t segmentShift)
    {
        if (m_count == 0) [[likely]]
            return;
        set(row, segmentShift, test(last));
        set(last, segmentShift, false);
    }

    [[nodiscard]] size_t bytes() const
    {
        return m_bits.capacity() * sizeof(uint64_t) + m_counts.capacity() * sizeof(uint32_t);
    }

private:
    [[nodiscard]] uint64_t wordAt(uint32_t word) const
    {
        return word < m_bits.size() ? m_bits[word] : 0;
    }
    // The first row in [row, end) that is as asked for; `end` if there is none.
    [[nodiscard]] uint32_t find(uint32_t row, uint32_t end, bool disabled) const;

    uint32_t m_count = 0;           // first: what every walk asks
    std::vector<uint64_t> m_bits;   // [row / 64]; rows beyond the archetype's are 0
    std::vector<uint32_t> m_counts; // [segment]
};

} // namespace penumbra::ecs
