#include "runtime/ecs/disabled_rows.h"

#include <algorithm>

namespace penumbra::ecs {

void DisabledRows::set(uint32_t row, uint32_t segmentShift, bool disabled)
{
    if (test(row) == disabled)
        return;
    const uint32_t segment = row >> segmentShift;
    makeRoom(row + 1, segmentShift);
    m_bits[row / 64] ^= uint64_t{1} << (row % 64);
    const uint32_t step = disabled ? 1 : ~0u; // up or down by one
    m_counts[segment] += step;
    m_count += step;
}

void DisabledRows::makeRoom(uint32_t rows, uint32_t segmentShift)
{
    if (const size_t words = (size_t{rows} + 63) / 64; words > m_bits.size())
        m_bits.resize(words);
    if (const size_t segments = ((size_t{rows} - 1) >> segmentShift) + 1;
        segments > m_counts.size())
        m_counts.resize(segments);
}

uint32_t DisabledRows::find(uint32_t row, uint32_t end, bool disabled) const
{
    while (row < end) {
        const uint64_t word = disabled ? wordAt(row / 64) : ~wordAt(row / 64);
        if (const uint64_t ahead = word >> (row % 64); ahead != 0)
            return std::min(end, row + static_cast<uint32_t>(std::countr_zero(ahead)));
        row = (row / 64 + 1) * 64;
    }
    return end;
}

} // namespace penumbra::ecs
