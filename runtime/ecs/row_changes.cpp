#include "runtime/ecs/row_changes.h"

#include <algorithm>

namespace penumbra::ecs {

void RowChanges::resize(uint32_t segmentCount)
{
    m_fresh.resize(size_t{segmentCount} * m_words);
    m_older.resize(size_t{segmentCount} * m_words);
    m_freshFrom.resize(segmentCount);
    m_olderFrom.resize(segmentCount);
}

void RowChanges::startFrame(uint32_t segment, uint64_t version)
{
    uint64_t* fresh = m_fresh.data() + size_t{segment} * m_words;
    uint64_t* older = m_older.data() + size_t{segment} * m_words;
    for (uint32_t i = 0; i < m_words; ++i) { // few: library calls take longer
        older[i] = fresh[i];
        fresh[i] = 0;
    }
    m_olderFrom[segment] = m_freshFrom[segment];
    m_freshFrom[segment] = version;
}

void RowChanges::mark(uint32_t segment, uint32_t row, uint32_t count)
{
    uint64_t* words = m_fresh.data() + size_t{segment} * m_words;
    for (const uint32_t end = row + count; row < end;) {
        const uint32_t bit = row % 64;
        const uint32_t length = std::min(64 - bit, end - row);
        words[row / 64] |= (~uint64_t{0} >> (64 - length)) << bit;
        row += length;
    }
}

} // namespace penumbra::ecs
