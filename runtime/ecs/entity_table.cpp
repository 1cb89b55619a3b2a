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

void EntityTable::allocateMany(std::span<Entity> out, std::span<const uint32_t> pages, uint32_t row)
{
    const auto place = [&] {
        const uint32_t at = pages[row >> kPageShift] << kPageShift | (row & (kPageRows - 1));
        ++row;
        return at;
    };
    const size_t reused = std::min<size_t>(out.size(), m_freeCount);
    uint32_t free = m_firstFree;
    for (Entity& entity : out.first(reused)) {
        Record& record = m_records[free];
        entity = {free, record.generation};
        free = record.place & ~kFree;
        record.place = place();
    }
    m_firstFree = free;
    m_freeCount -= static_cast<uint32_t>(reused);
    for (Entity& entity : out.subspan(reused)) {
        entity = {static_cast<uint32_t>(m_records.size()), 1};
        m_records.push_back({1, place()});
    }
    m_count += static_cast<uint32_t>(out.size());
    ++m_moves;
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
    table.m_count = count;
    table.m_moves = m_moves + 1;
    *this = std::move(table);
}

size_t EntityTable::bytes() const
{
    return m_records.capacity() * sizeof(Record) + m_pages.capacity() * sizeof(Page) +
           m_freePages.capacity() * sizeof(uint32_t);
}

} // namespace penumbra::ecs
