// Which rows of one column changed, for components that opt in with kRowChanges: two bits per row.
// `fresh` holds the rows written in the latest frame that wrote the segment, `older` the frame
// before. A reader that is further behind is told "all rows of a changed segment": changes are
// never missed, at worst reported for a row that a reader of that age has seen already.
#pragma once

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

class RowChanges {
public:
    explicit RowChanges(uint32_t segmentRows) : m_words((segmentRows + 63) / 64) {}

    void resize(uint32_t segmentCount);

    // To call before the first write of a frame to a segment, whose last write was at `version`.
    void startFrame(uint32_t segment, uint64_t version);

    // Rows count from the segment's start.
    void mark(uint32_t segment, uint32_t row)
    {
        m_fresh[segment * m_words + row / 64] |= uint64_t{1} << (row % 64);
    }
    void mark(uint32_t segment, uint32_t row, uint32_t count);

    // Bits of rows word*64 … word*64+63 that may have changed after version `since`.
    [[nodiscard]] uint64_t changed(uint32_t segment, uint32_t word, uint64_t since) const
    {
        if (since < m_olderFrom[segment])
            return ~uint64_t{0};
        const uint32_t at = segment * m_words + word;
        return since < m_freshFrom[segment] ? m_fresh[at] | m_older[at] : m_fresh[at];
    }

    [[nodiscard]] size_t bytes() const
    {
        return (m_fresh.capacity() + m_older.capacity() + m_freshFrom.capacity() +
                m_olderFrom.capacity()) *
               sizeof(uint64_t);
    }

private:
    uint32_t m_words; // per segment: segments share no word, so threads may mark in parallel
    std::vector<uint64_t> m_fresh, m_older;         // [segment][word]
    std::vector<uint64_t> m_freshFrom, m_olderFrom; // [segment] bits cover changes after this
};

} // namespace penumbra::ecs
