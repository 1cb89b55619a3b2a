#include "runtime/ecs/entity_table.h"

#include "runtime/assert.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace penumbra::ecs {

namespace {

constexpr uint32_t kRunGroup = 64; // free indices that are taken at once

// Two records or entities, each as one number.
using Pair [[gnu::vector_size(16)]] = uint64_t;
static_assert(std::endian::native == std::endian::little);

// kRunGroup free records from index `low` on become entities at `place` and after it: the first one
// is the lowest, or going down (kStep) the highest. Written as vectors because compilers leave the
// way down, with one array forwards and one backwards, a loop of numbers (half as fast).
template <int kStep>
void takeGroup(void* records, uint64_t low, uint64_t place, void* entities)
{
    constexpr uint32_t kPairs = kRunGroup / 2;
    constexpr uint64_t kLast = kRunGroup - 1;
    auto* const from = static_cast<std::byte*>(records);
    auto* const to = static_cast<std::byte*>(entities);
    Pair index = {low, low + 1};
    Pair at = kStep > 0 ? Pair{place, place + 1} : Pair{place + kLast, place + kLast - 1};
    for (uint32_t i = 0; i < kPairs; ++i) {
        const uint32_t k = kStep > 0 ? i : kPairs - 1 - i;
        Pair generation;
        std::memcpy(&generation, from + i * sizeof(Pair), sizeof(Pair));
        generation &= 0xffffffffu;
        const Pair record = at << 32 | generation, entity = generation << 32 | index;
        const Pair turned = kStep > 0 ? entity : Pair{entity[1], entity[0]};
        std::memcpy(from + i * sizeof(Pair), &record, sizeof(Pair));
        std::memcpy(to + k * sizeof(Pair), &turned, sizeof(Pair));
        index += 2;
        at += kStep > 0 ? 2 : uint64_t{0} - 2;
    }
}

} // namespace

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

// One run of free indices that follow each other, up or down (kStep), as they mostly do: then no
// load waits for the one before. Takes whole groups of kRunGroup, at most out.size(); returns how
// many.
template <int kStep>
uint32_t EntityTable::reuseRun(std::span<Entity> out, uint32_t place)
{
    uint32_t done = 0;
    for (; done + kRunGroup <= out.size(); done += kRunGroup) {
        const uint32_t first = m_firstFree;
        if (kStep > 0 ? indexCount() - first <= kRunGroup : first < kRunGroup)
            break;
        const uint32_t low = kStep > 0 ? first : first - (kRunGroup - 1);
        Record* const records = m_records.data() + low;
        uint32_t others = 0; // bits in which a link differs from one to the neighbour
        for (uint32_t i = 0; i < kRunGroup; ++i)
            others |= records[i].place ^ (kFree | (low + i + static_cast<uint32_t>(kStep)));
        if (others != 0)
            break;
        for (uint32_t line = 0; line < kRunGroup; line += 64 / sizeof(Entity))
            __builtin_prefetch(out.data() + done + 2 * kRunGroup + line, 1);
        takeGroup<kStep>(records, low, place + done, out.data() + done);
        m_firstFree = first + kRunGroup * static_cast<uint32_t>(kStep);
    }
    m_freeCount -= done;
    return done;
}

// Entities for `place` and the places after it from the free indices, up to out.size().
uint32_t EntityTable::reuse(std::span<Entity> out, uint32_t place)
{
    const auto most = static_cast<uint32_t>(std::min<size_t>(out.size(), m_freeCount));
    uint32_t done = 0;
    while (done < most) {
        const std::span<Entity> rest = out.subspan(done, most - done);
        if (const uint32_t next = m_records[m_firstFree].place & ~kFree; next == m_firstFree + 1)
            done += reuseRun<1>(rest, place + done);
        else if (next + 1 == m_firstFree)
            done += reuseRun<-1>(rest, place + done);
        for (uint32_t i = 0; i < kRunGroup && done < most; ++i, ++done)
            out[done] = allocateAt(place + done);
    }
    return done;
}

void EntityTable::allocateMany(std::span<Entity> out, uint32_t page, uint32_t row)
{
    const uint32_t place = page << kPageShift | (row & (kPageRows - 1));
    for (uint32_t done = reuse(out, place); done < out.size(); ++done) {
        out[done] = {indexCount(), 1};
        m_records.push_back({1, place + done});
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
