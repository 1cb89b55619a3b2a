#include "runtime/ecs/entity_table.h"

#include "runtime/assert.h"

#include <algorithm>

namespace penumbra::ecs {

void EntityTable::grow(size_t count)
{
    PENUMBRA_ASSERT(m_records.size() + count < kFree, "{} entities do not fit",
                    m_records.size() + count);
    reserveSparingly(m_records, m_records.size() + count);
}

Entity EntityTable::allocateNew()
{
    m_records.push_back({});
    return {static_cast<uint32_t>(m_records.size() - 1), 1};
}

Entity EntityTable::allocateNewAt(uint32_t place)
{
    reserve(1);
    m_records.push_back({1, place});
    return {indexCount() - 1, 1};
}

// The next free indices for entities at `place` and the places after it, up to out.size(): those
// that follow each other, up or down, as they mostly do. Then no load waits for the one before.
uint32_t EntityTable::reuse(std::span<Entity> out, uint32_t place)
{
    const auto most = static_cast<uint32_t>(std::min<size_t>(out.size(), m_freeCount));
    Record* const records = m_records.data();
    const uint32_t first = m_firstFree;
    const uint32_t step = (records[first].place & ~kFree) - first;
    uint32_t count = 1;
    while (count < most && (step == 1 || step == ~0u) &&
           records[first + (count - 1) * step].place == (kFree | (first + count * step)))
        ++count;
    m_firstFree = records[first + (count - 1) * step].place & ~kFree;
    m_freeCount -= count;
    for (uint32_t i = 0; i < count; ++i) {
        Record& record = records[first + i * step];
        out[i] = {first + i * step, record.generation};
        record.place = place + i;
    }
    return count;
}

void EntityTable::allocateMany(std::span<Entity> out, std::span<const uint32_t> pages, uint32_t row)
{
    while (!out.empty()) { // page by page: within one, places are numbers in a row
        const uint32_t inPage = row & (kPageRows - 1);
        const uint32_t place = pages[row >> kPageShift] << kPageShift | inPage;
        const auto length = static_cast<uint32_t>(std::min<size_t>(out.size(), kPageRows - inPage));
        uint32_t done = 0;
        while (done < length && m_freeCount > 0)
            done += reuse(out.subspan(done, length - done), place + done);
        for (; done < length; ++done) {
            out[done] = {indexCount(), 1};
            m_records.push_back({1, place + done});
        }
        row += length;
        out = out.subspan(length);
    }
}

uint32_t EntityTable::addPage(Archetype* archetype, uint32_t firstRow)
{
    if (m_freePages.empty()) {
        m_freePages.reserve(m_pages.size() + 1); // so that removePage() does not allocate
        PENUMBRA_ASSERT(m_pages.size() < kFree >> kPageShift, "{} pages of rows", m_pages.size());
        m_pages.push_back({archetype, firstRow});
        return static_cast<uint32_t>(m_pages.size() - 1);
    }
    const uint32_t page = m_freePages.back();
    m_freePages.pop_back();
    m_pages[page] = {archetype, firstRow};
    return page;
}

void EntityTable::removePage(uint32_t page)
{
    m_pages[page] = {nullptr, 0};
    m_freePages.push_back(page);
}

std::vector<uint32_t> EntityTable::freeIndices() const
{
    std::vector<uint32_t> free(m_freeCount);
    uint32_t next = m_firstFree;
    for (size_t i = free.size(); i-- > 0; next = m_records[next].place & ~kFree)
        free[i] = next;
    return free;
}

void EntityTable::restore(std::span<const uint32_t> generations, std::span<const uint32_t> free,
                          uint32_t count)
{
    PENUMBRA_ASSERT(generations.size() < kFree, "{} entities do not fit", generations.size());
    EntityTable table;
    table.m_records.reserve(generations.size());
    for (const uint32_t generation : generations)
        table.m_records.push_back({generation, kFree});
    for (const uint32_t index : free) {
        table.m_records[index].place = kFree | table.m_firstFree;
        table.m_firstFree = index;
    }
    table.m_freeCount = static_cast<uint32_t>(free.size());
    table.m_retired = table.indexCount() - table.m_freeCount - count;
    table.m_moves = m_moves + 1;
    *this = std::move(table);
}

size_t EntityTable::bytes() const
{
    return m_records.capacity() * sizeof(Record) + m_pages.capacity() * sizeof(Page) +
           m_freePages.capacity() * sizeof(uint32_t);
}

} // namespace penumbra::ecs
