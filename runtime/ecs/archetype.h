// Archetype: the rows of all entities that have exactly the same components.
//
// A row's values lie in blocks, column by column. The first block grows 1 -> 4 -> 16 -> 128 KiB
// (about: a block holds a power of two of rows), further blocks are full ones, so that small
// archetypes stay small and large ones run at the speed of plain arrays. A segment is the part of a
// block of about 16 KiB: the unit of change versions and of parallel work. Entity ids lie apart.
//
//   block   [column 0: rows x bytes][gap][column 1: rows x bytes] …   eight segments when full
//   row r   block r >> blockShift, at r & (blockRows - 1)
//
// A component split into lanes has one column per lane, side by side in the column list.
// Threads may work on different segments, and on different columns of one segment, at once.
#pragma once

#include "runtime/ecs/component.h"
#include "runtime/ecs/disabled_rows.h"
#include "runtime/ecs/entity_table.h"
#include "runtime/ecs/row_changes.h"

namespace penumbra::ecs {

inline constexpr uint32_t kSegmentBytes = 16 * 1024; // half an L1 cache
inline constexpr uint32_t kFirstBlockBytes = 1024;
inline constexpr uint32_t kBlockSegmentShift =
    3; // full block: 128 KiB, beyond it nothing is gained
inline constexpr uint32_t kBlockSegments = 1u << kBlockSegmentShift;

struct Column {
    ComponentId component = 0;
    uint16_t lane = 0;
    uint32_t bytes = 0;      // of one row
    uint32_t prefix = 0;     // bytes of one row in the columns before
    uint32_t offset = 0;     // of row 0 in a block, at the current block size
    int32_t rowChanges = -1; // index into m_rowChanges; on a component's first lane only
    const ComponentLife* life = nullptr; // null: trivially copyable
};

class Archetype {
public:
    Archetype(uint32_t index, const ComponentMask& mask);
    ~Archetype();
    Archetype(const Archetype&) = delete;
    Archetype& operator=(const Archetype&) = delete;

    [[nodiscard]] uint32_t index() const { return m_index; }
    [[nodiscard]] const ComponentMask& mask() const { return m_mask; }
    [[nodiscard]] std::span<const Entity> entities() const { return m_entities; }
    [[nodiscard]] uint32_t count() const { return static_cast<uint32_t>(m_entities.size()); }
    [[nodiscard]] uint32_t segmentShift() const { return m_segmentShift; }
    [[nodiscard]] uint32_t segmentRows() const { return 1u << m_segmentShift; }
    [[nodiscard]] uint32_t blockRows() const { return 1u << m_blockShift; }
    [[nodiscard]] uint32_t segmentCount() const
    {
        return (count() + segmentRows() - 1) >> m_segmentShift;
    }

    // First column of a component; -1 if it is absent or a tag.
    [[nodiscard]] int32_t columnOf(ComponentId id) const { return m_columnOf[id]; }
    [[nodiscard]] std::span<const Column> columns() const { return m_columns; }
    [[nodiscard]] std::byte* at(uint32_t column, uint32_t row) const
    {
        const Column& c = m_columns[column];
        return m_blocks[row >> m_blockShift] + c.offset + size_t{row & (blockRows() - 1)} * c.bytes;
    }

    // Structure. reserve() makes room for that many rows in all; it alone allocates, and where it
    // throws nothing has changed. append() leaves the values of the new rows as they are, unset or
    // filled before, and returns the first row. removeRow() destroys the row's values, moves the
    // last row into the gap and returns the entity that moved, or null; closeGap() does the same
    // for a row whose values are gone. New and moved rows count as changed in all components.
    [[nodiscard]] bool hasRoom(uint32_t more) const { return m_capacity - count() >= more; }
    void reserve(uint32_t rows);
    uint32_t append(std::span<const Entity> entities, Stamp stamp);
    uint32_t append(Entity entity, Stamp stamp) // room is there
    {
        const uint32_t row = count();
        m_entities.push_back(entity);
        markStructural(row, stamp);
        return row;
    }
    Entity removeRow(uint32_t row, Stamp stamp)
    {
        if (m_hasLife) [[unlikely]]
            destroyRow(row);
        return closeGap(row, stamp);
    }
    Entity closeGap(uint32_t row, Stamp stamp);
    // The values of the components that both have come over; the source's others are destroyed: its
    // row is to be closed. Values of components that the source lacks are unset.
    void moveRow(uint32_t row, Archetype& source, uint32_t sourceRow);
    // The same for rows [row, row + sourceRows.size()), column by column.
    void moveRows(uint32_t row, Archetype& source, std::span<const uint32_t> sourceRows);
    void trim(); // gives back blocks without rows

    // Whole values by type, whatever their lanes. Writing does not mark. For values that are not
    // trivially copyable: read() and write() are not for them; fill() constructs, and destroys what
    // it made if a copy throws.
    void read(ComponentId id, uint32_t row, void* value) const;
    void write(ComponentId id, uint32_t row, const void* value);
    // rows [row, row + count), within room, from values `stride` bytes apart; stride 0 repeats one
    // value.
    void fill(ComponentId id, uint32_t row, uint32_t count, const void* values, size_t stride);
    // Destroys values of a component that is not trivially copyable.
    void destroyValues(ComponentId id, uint32_t row, uint32_t count);
    // Such a value moves in, over the old one if the row holds one; `value` stays to be destroyed.
    void moveIn(ComponentId id, uint32_t row, void* value, bool over);

    // Where the values of one row lie, for code that writes several columns.
    struct RowPlace {
        std::byte* block;
        size_t row; // within the block
        const Column* columns;
        const int16_t* columnOf;
    };
    [[nodiscard]] RowPlace rowPlace(uint32_t row) const
    {
        return {m_blocks[row >> m_blockShift], row & (blockRows() - 1), m_columns.data(),
                m_columnOf.data()};
    }

    // Change marks. `column` is the first column of a component.
    void markRow(uint32_t column, uint32_t row, Stamp stamp)
    {
        const uint32_t segment = row >> m_segmentShift;
        touch(column, segment, stamp);
        if (const int32_t changes = m_columns[column].rowChanges; changes >= 0)
            m_rowChanges[changes].mark(segment, row & (segmentRows() - 1));
    }
    // Rows count from the segment's start.
    void markRows(uint32_t column, uint32_t segment, uint32_t row, uint32_t count, Stamp stamp)
    {
        touch(column, segment, stamp);
        if (const int32_t changes = m_columns[column].rowChanges; changes >= 0)
            m_rowChanges[changes].mark(segment, row, count);
    }
    // All rows.
    void markAll(uint32_t column, Stamp stamp)
    {
        if (m_columns[column].rowChanges >= 0)
            return markAllRows(column, stamp);
        uint64_t* version = m_versions.data() + column;
        for (uint32_t s = segmentCount(); s > 0; --s, version += m_columns.size())
            *version = stamp.version;
        __atomic_store_n(&m_columnVersions[column], stamp.version, __ATOMIC_RELAXED);
    }
    [[nodiscard]] uint64_t version(uint32_t column, uint32_t segment) const
    {
        return m_versions[size_t{segment} * m_columns.size() + column];
    }
    // The newest of all segments.
    [[nodiscard]] uint64_t version(uint32_t column) const
    {
        return __atomic_load_n(&m_columnVersions[column], __ATOMIC_RELAXED);
    }
    // Bits of 64 rows that may have changed after `since`: see RowChanges. All of a changed segment
    // for a component that did not opt in.
    [[nodiscard]] uint64_t changedRows(uint32_t column, uint32_t segment, uint32_t word,
                                       uint64_t since) const
    {
        if (version(column, segment) <= since)
            return 0;
        const int32_t changes = m_columns[column].rowChanges;
        return changes < 0 ? ~uint64_t{0} : m_rowChanges[changes].changed(segment, word, since);
    }

    // Disabled rows (World::setEnabled). A row that is enabled again counts as changed: readers
    // that skipped it may have missed something.
    [[nodiscard]] const DisabledRows& disabled() const { return m_disabled; }
    void setDisabled(uint32_t row, bool disabled, Stamp stamp)
    {
        if (!disabled && m_disabled.test(row))
            markStructural(row, 1, stamp);
        m_disabled.set(row, m_segmentShift, disabled);
    }
    // `more` rows may then be appended and disabled without allocation.
    void makeDisabledRoom(uint32_t more) { m_disabled.makeRoom(count() + more, m_segmentShift); }

    [[nodiscard]] size_t blockBytes() const { return m_blocks.size() * m_blockBytes; }
    [[nodiscard]] size_t valueBytes() const { return size_t{count()} * m_rowBytes; }
    [[nodiscard]] size_t bookBytes() const;

    // Kept here for World. Where adding or removing a ComponentSet leads, by slot; null until asked
    // for the first time. And the EntityTable's pages of the rows.
    std::vector<Archetype*> withSet, withoutSet;
    std::vector<uint32_t> pages;

private:
    [[nodiscard]] size_t layOutColumns(std::vector<Column>& columns, uint32_t blockShift) const;
    void growFirstBlock();
    void destroyRow(uint32_t row);
    void markAllRows(uint32_t column, Stamp stamp);
    void markStructural(uint32_t row, uint32_t count, Stamp stamp);
    // The same for one row. Rows come and go one after the other in one segment: if all its columns
    // have the version already, only the row bits are left to set.
    void markStructural(uint32_t row, Stamp stamp)
    {
        const uint32_t segment = row >> m_segmentShift;
        if (segment != m_stampedSegment || stamp.version != m_stampedVersion)
            return markStructural(row, 1, stamp);
        for (RowChanges& changes : m_rowChanges)
            changes.mark(segment, row & (segmentRows() - 1));
    }
    // Different columns, and different segments of one column, may be touched at once; a column is
    // only ever written under one version at a time.
    void touch(uint32_t column, uint32_t segment, Stamp stamp)
    {
        uint64_t& version = m_versions[size_t{segment} * m_columns.size() + column];
        if (version == stamp.version)
            return;
        const int32_t changes = m_columns[column].rowChanges;
        if (changes >= 0 && version <= stamp.frameBase)
            m_rowChanges[changes].startFrame(segment, version);
        version = stamp.version;
        if (this->version(column) < stamp.version)
            __atomic_store_n(&m_columnVersions[column], stamp.version, __ATOMIC_RELAXED);
    }

    std::vector<Entity> m_entities;   // [count]
    std::vector<std::byte*> m_blocks; // owned, all of one size
    std::vector<Column> m_columns;
    std::vector<uint64_t> m_versions; // [segment][column], of the last write; first lanes only
    std::vector<uint64_t> m_columnVersions; // [column]
    std::vector<RowChanges> m_rowChanges;
    DisabledRows m_disabled;
    std::array<int16_t, kMaxComponents> m_columnOf;
    ComponentMask m_mask;
    uint32_t m_index;
    uint32_t m_rowBytes = 0;
    uint32_t m_blockShift = 0; // log2 of the rows in a block, as of now
    uint32_t m_segmentShift = 0;
    uint32_t m_capacity = 0; // rows that have room in everything
    bool m_hasLife = false;  // some column is not trivially copyable
    size_t m_blockBytes = 0;
    uint32_t m_stampedSegment = kNone; // markStructural's last
    uint64_t m_stampedVersion = 0;
};

} // namespace penumbra::ecs
