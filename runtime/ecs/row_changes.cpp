#include "runtime/ecs/row_changes.h"

#include <algorithm>

namespace penumbra::ecs {

void RowChanges::resize(uint32_t segmentCount)
{
    m_bits.resize(size_t{segmentCount} * 2 * m_words);
    m_from.resize(segmentCount);
}

void RowChanges::mark(uint32_t segment, uint32_t row, uint32_t count)
{
    uint64_t* const words = fresh(segment);
    for (const uint32_t end = row + count; row < end;) {
        const uint32_t bit = row % 64;
        const uint32_t length = std::min(64 - bit, end - row);
        words[row / 64] |= (~uint64_t{0} >> (64 - length)) << bit;
        row += length;
    }
}

} // namespace penumbra::ecs
