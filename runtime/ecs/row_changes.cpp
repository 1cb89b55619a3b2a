#include "runtime/ecs/row_changes.h"

namespace penumbra::ecs {

void RowChanges::resize(uint32_t rows)
{
    m_fresh.resize(rows >> m_shift);
    m_older.resize(rows >> m_shift);
    m_oldest.resize(rows >> m_shift);
}

void RowChanges::trim(uint32_t rows)
{
    resize(rows);
    for (std::vector<uint64_t>* const words : {&m_fresh, &m_older, &m_oldest})
        words->shrink_to_fit();
}

void RowChanges::startFrame(uint64_t version)
{
    m_older.swap(m_oldest);
    m_fresh.swap(m_older);
    std::fill(m_fresh.begin(), m_fresh.end(), 0);
    m_olderFrom = m_freshFrom;
    m_freshFrom = version;
}

void RowChanges::mark(uint32_t row, uint32_t count)
{
    for (const uint32_t end = row + count; row < end;) {
        const uint32_t bit = row & m_mask;
        const uint32_t length = std::min(m_mask + 1 - bit, end - row);
        m_fresh[row >> m_shift] |= (~uint64_t{0} >> (64 - length)) << bit;
        row += length;
    }
}

} // namespace penumbra::ecs
