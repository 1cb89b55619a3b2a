// Which rows of one column changed, where components opt in with kRowChanges: three bits per row.
// `fresh` holds the rows written in the latest frame that wrote the column, `older` the frame
// before; a third set is for walks that begin a frame. A reader that is further behind is told "all
// rows of a changed segment": changes are never missed, at worst reported for a row that a reader
// of that age has seen already. Frames begin for a column, not for each segment: where rows are
// written here and there, two writes of five are their segment's first, which no processor
// foretells.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace penumbra::ecs {

// The time of a write. Versions grow with each system of each frame; frameBase is the version
// before the frame's first system, so version > frameBase.
struct Stamp {
    uint64_t version = 0;
    uint64_t frameBase = 0;
};

// The rows of one column that may have changed after some version. A walk that took it before its
// own writes loses none of them, though one of those begin a frame. (What code it calls writes
// elsewhere in the column may or may not be among them.)
struct ChangedRows {
    uint64_t always = 0;             // in every word
    const uint64_t* fresh = nullptr; // [row >> shift], null: none
    const uint64_t* older = nullptr;
    uint32_t shift = 0;
    // The rows from `row` on, 64 or to the end of the segment: a segment begins there, or 64 rows.
    [[nodiscard]] uint64_t word(uint32_t row) const
    {
        const uint32_t i = row >> shift;
        return always | (fresh != nullptr ? fresh[i] : 0) | (older != nullptr ? older[i] : 0);
    }
};

class RowChanges {
public:
    explicit RowChanges(uint32_t segmentShift)
        : m_shift(std::min(segmentShift, 6u)), m_mask((1u << m_shift) - 1)
    {}

    void resize(uint32_t rows); // whole segments
    void trim(uint32_t rows);   // the same, and gives memory back

    // To call before the first write of a frame; the last one was at `version`.
    void startFrame(uint64_t version);

    void mark(uint32_t row) { m_fresh[row >> m_shift] |= uint64_t{1} << (row & m_mask); }
    void mark(uint32_t row, uint32_t count);

    [[nodiscard]] ChangedRows changed(uint64_t since) const
    {
        if (since < m_olderFrom)
            return {~uint64_t{0}};
        return {0, m_fresh.data(), since < m_freshFrom ? m_older.data() : nullptr, m_shift};
    }

    [[nodiscard]] size_t bytes() const
    {
        return (m_fresh.capacity() + m_older.capacity() + m_oldest.capacity()) * sizeof(uint64_t);
    }

private:
    // Segments share no word, so that threads may mark in different ones: those of less than 64
    // rows fill theirs in part.
    std::vector<uint64_t> m_fresh, m_older; // [row >> m_shift]
    // What was `older`, kept for the walk whose write began the frame: at most one frame begins in
    // a walk, as none may advance() the world.
    std::vector<uint64_t> m_oldest;
    uint32_t m_shift;
    uint32_t m_mask;
    uint64_t m_freshFrom = 0, m_olderFrom = 0; // bits cover changes after this
};

} // namespace penumbra::ecs
