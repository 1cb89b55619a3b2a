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

// The rows of one segment that may have changed after some version, 64 to a word.
struct ChangedBits {
    uint64_t always = 0;             // in every word
    const uint64_t* fresh = nullptr; // [word], null: none
    const uint64_t* older = nullptr;
    [[nodiscard]] uint64_t word(uint32_t i) const
    {
        return always | (fresh != nullptr ? fresh[i] : 0) | (older != nullptr ? older[i] : 0);
    }
};

class RowChanges {
public:
    explicit RowChanges(uint32_t segmentRows) : m_words((segmentRows + 63) / 64) {}

    void resize(uint32_t segmentCount);

    // To call before the first write of a frame to a segment, whose last write was at `version`.
    void startFrame(uint32_t segment, uint64_t version)
    {
        uint64_t* const bits = fresh(segment);
        for (uint32_t i = 0; i < m_words; ++i) { // few: library calls take longer
            bits[m_words + i] = bits[i];
            bits[i] = 0;
        }
        m_from[segment] = {version, m_from[segment].fresh};
    }

    // Rows count from the segment's start.
    void mark(uint32_t segment, uint32_t row)
    {
        fresh(segment)[row / 64] |= uint64_t{1} << (row % 64);
    }
    void mark(uint32_t segment, uint32_t row, uint32_t count);

    [[nodiscard]] ChangedBits changed(uint32_t segment, uint64_t since) const
    {
        if (since < m_from[segment].older)
            return {~uint64_t{0}};
        const uint64_t* const bits = m_bits.data() + size_t{segment} * 2 * m_words;
        return {0, bits, since < m_from[segment].fresh ? bits + m_words : nullptr};
    }

    [[nodiscard]] size_t bytes() const
    {
        return m_bits.capacity() * sizeof(uint64_t) + m_from.capacity() * sizeof(From);
    }

private:
    struct From { // bits cover changes after this
        uint64_t fresh = 0, older = 0;
    };
    [[nodiscard]] uint64_t* fresh(uint32_t segment)
    {
        return m_bits.data() + size_t{segment} * 2 * m_words;
    }

    uint32_t m_words; // per segment: segments share no word, so threads may mark in parallel
    std::vector<uint64_t> m_bits; // [segment][fresh, older][word]
    std::vector<From> m_from;     // [segment]
};

} // namespace penumbra::ecs
