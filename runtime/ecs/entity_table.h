// EntityTable: where each entity's row is. 8 bytes per index ever used, outside the data blocks: a
// generation and a place. A place names a page of 4096 rows of one archetype, and a row in it; the
// few pages stay in the cache, so that finding a row costs one cache miss, not two.
// Free indices form a list through their records, last in first out: equal histories give equal
// ids, and giving an index back never allocates.
#pragma once

#include "runtime/ecs/entity.h"

#include <cstddef>
#include <span>
#include <vector>

namespace penumbra::ecs {

class Archetype;

inline constexpr uint32_t kNone = ~0u;

struct Place {
    Archetype* archetype;
    uint32_t row;
};

// log2 of the rows of a page; no segment is larger. 2^19 pages fit a place.
inline constexpr uint32_t kPageShift = 12;
inline constexpr uint32_t kPageRows = 1u << kPageShift;

class EntityTable {
public:
    [[nodiscard]] bool alive(Entity entity) const
    {
        return entity.index < m_records.size() &&
               m_records[entity.index].generation == entity.generation &&
               (m_records[entity.index].place & kFree) == 0;
    }
    // Of a living entity.
    [[nodiscard]] Place place(Entity entity) const
    {
        const uint32_t place = m_records[entity.index].place;
        const Page& page = m_pages[place >> kPageShift];
        return {page.archetype, page.firstRow + (place & (kPageRows - 1))};
    }
    // `page` holds the row: Archetype::pages[row >> kPageShift].
    void setPlace(Entity entity, uint32_t page, uint32_t row)
    {
        setFirstPlace(entity, page, row);
        ++m_moves;
    }
    void setFirstPlace(Entity entity, uint32_t page, uint32_t row) // of a new entity
    {
        m_records[entity.index].place = page << kPageShift | (row & (kPageRows - 1));
    }

    // Room for `count` allocations, which then do not fail.
    void reserve(size_t count)
    {
        if (count > m_freeCount && m_records.capacity() - m_records.size() < count - m_freeCount)
            grow(count - m_freeCount);
    }
    // The new entity is alive once it has a place, which the caller sets.
    Entity allocate()
    {
        if (m_freeCount == 0)
            return allocateNew();
        const uint32_t index = m_firstFree;
        m_firstFree = m_records[index].place & ~kFree;
        --m_freeCount;
        return {index, m_records[index].generation};
    }
    // The same at once, with its place; makes room if it must.
    Entity allocateAt(uint32_t place)
    {
        if (m_freeCount == 0) [[unlikely]]
            return allocateNewAt(place);
        const uint32_t index = m_firstFree;
        Record& record = m_records[index];
        m_firstFree = record.place & ~kFree;
        --m_freeCount;
        record.place = place;
        return {index, record.generation};
    }
    // For rows [row, row + out.size()) of one page; room is there.
    void allocateMany(std::span<Entity> out, uint32_t page, uint32_t row);
    void release(Entity entity)
    {
        Record& record = m_records[entity.index];
        record.place = kFree | m_firstFree;
        ++m_moves;
        // The last generation below the deferred bit retires the index: no id ever comes back.
        if (++record.generation < (1u << 31)) {
            m_firstFree = entity.index;
            ++m_freeCount;
        } else {
            ++m_retired;
        }
    }

    // A page for rows [firstRow, firstRow + kPageRows) of an archetype.
    uint32_t addPage(Archetype* archetype, uint32_t firstRow);
    void removePage(uint32_t page);

    // For snapshots: the free indices, next one last; and a table that has all those indices, the
    // others without a place yet. Places remembered before do not hold.
    [[nodiscard]] std::vector<uint32_t> freeIndices() const;
    void restore(std::span<const uint32_t> generations, std::span<const uint32_t> free,
                 uint32_t count);

    [[nodiscard]] uint32_t generation(uint32_t index) const { return m_records[index].generation; }
    [[nodiscard]] uint32_t count() const { return indexCount() - m_freeCount - m_retired; }
    [[nodiscard]] uint32_t indexCount() const { return static_cast<uint32_t>(m_records.size()); }
    // Grows whenever an entity got another place: tells whether remembered places still hold.
    [[nodiscard]] uint64_t moves() const { return m_moves; }
    [[nodiscard]] size_t bytes() const;

private:
    static constexpr uint32_t kFree = 1u << 31;

    struct Record {
        uint32_t generation = 1; // of the living entity, or of the next one if the index is free
        uint32_t place = kFree;  // page and row, or kFree and the next free index
    };
    struct Page {
        Archetype* archetype;
        uint32_t firstRow;
    };

    Entity allocateNew();
    Entity allocateNewAt(uint32_t place);
    template <int kStep>
    uint32_t reuseRun(std::span<Entity> out, uint32_t place);
    uint32_t reuse(std::span<Entity> out, uint32_t place);
    void grow(size_t count);

    std::vector<Record> m_records; // [index]
    std::vector<Page> m_pages;
    std::vector<uint32_t> m_freePages;
    uint64_t m_moves = 0;
    uint32_t m_firstFree = 0; // of m_freeCount
    uint32_t m_freeCount = 0;
    uint32_t m_retired = 0; // indices
};

// Arrays with an element per entity grow by a quarter, not twofold: at a million entities what is
// unused would otherwise be as much as what is used. Doubling while small.
template <class T>
void reserveSparingly(std::vector<T>& values, size_t count)
{
    if (count <= values.capacity())
        return;
    const size_t step = values.capacity() < 4096 ? values.capacity() : values.capacity() / 4;
    values.reserve(count > values.capacity() + step ? count : values.capacity() + step);
}

} // namespace penumbra::ecs
