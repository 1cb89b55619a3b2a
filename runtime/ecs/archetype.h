// Archetype: the rows of all entities that have exactly the same components.
//
// A row's values lie in blocks, column by column. The first block grows 1 -> 4 -> 16 -> 64 -> 256
// -> 512 KiB (about: a block holds a power of two of rows), further blocks are full ones, so that
// small archetypes stay small and large ones run at the speed of plain arrays. A segment is the
// part of a block of about 16 KiB: the unit of change versions and of parallel work. Entity ids lie
// apart.
//
//   block   [column 0: rows x bytes][gap][column 1: rows x bytes] …   32 segments when full
//   row r   block r >> blockShift, at r & (blockRows - 1)
//
// A component split into lanes has one column per lane, side by side in the column list.
// Threads may work on different segments, and on different columns of one segment, at once.
#pragma once

#include "runtime/ecs/column.h"
#include "runtime/ecs/disabled_rows.h"
#include "runtime/ecs/entity_table.h"
#include "runtime/ecs/row_changes.h"

namespace penumbra::ecs {

inline constexpr uint32_t kSegmentBytes = 16 * 1024; // half an L1 cache
inline constexpr uint32_t kFirstBlockBytes = 1024;
// Full block: 512 KiB. Where each loop begins, nothing is prefetched yet.
inline constexpr uint32_t kBlockSegmentShift = 5;
inline constexpr uint32_t kBlockSegments = 1u << kBlockSegmentShift;

class alignas(64) Archetype { // a cache line
public:
    Archetype(uint32_t index, const ComponentMask& mask);
    ~Archetype();
    Archetype(const Archetype&) = delete;
    Archetype& operator=(const Archetype&) = delete;

    [[nodiscard]] uint32_t index() const { return m_index; }
    [[nodiscard]] const ComponentMask& mask() const { return m_mask; }
    [[nodiscard]] std::span<const Entity> entities() const { return {m_entities.data(), count()}; }
    [[nodiscard]] uint32_t count() const { return static_cast<uint32_t>(m_shape); }
    [[nodiscard]] uint32_t segmentShift() const { return m_segmentShift; }
    [[nodiscard]] uint32_t segmentRows() const { return 1u << m_segmentShift; }
    [[nodiscard]] uint32_t blockRows() const { return m_blockMask + 1; }
    [[nodiscard]] uint32_t segmentCount() const
    {
        return (count() + segmentRows() - 1) >> m_segmentShift;
    }

    // First column of a component; -1 if it is absent or a tag.
    [[nodiscard]] int32_t columnOf(ComponentId id) const { return m_columnOf[id]; }
    [[nodiscard]] std::span<const Column> columns() const { return m_columns; }
    [[nodiscard]] std::byte* at(uint32_t column, uint32_t row) const
    {
        return columnsAt(row)[column] + rowInBlock(row) * m_columns[column].bytes;
    }
    // Where the columns of the row's block begin, [column].
    [[nodiscard]] std::byte* const* columnsAt(uint32_t row) const
    {
        return m_columnsAt.data() + size_t{row >> m_blockShift} * m_columnCount;
    }
    [[nodiscard]] uint32_t columnCount() const { return m_columnCount; }
    // layout() in the upper, count() in the lower half. The layout is 0 unless all rows lie in one
    // block and none is disabled; then a number that is another one whenever columnsAt(0) is.
    [[nodiscard]] uint64_t shape() const { return m_shape; }
    [[nodiscard]] uint32_t layout() const { return static_cast<uint32_t>(m_shape >> 32); }
    [[nodiscard]] size_t rowInBlock(uint32_t row) const { return row & m_blockMask; }

    // Structure. reserve() makes room for that many rows in all; it alone allocates, and where it
    // throws nothing has changed. append() leaves the values of the new rows as they are, unset or
    // filled before, and returns the first row. removeRow() destroys the row's values, moves the
    // last row into the gap and returns the entity that moved, or null; closeGap() does the same
    // for a row whose values are gone. New and moved rows count as changed in all components.
    [[nodiscard]] bool hasRoom(uint32_t more) const { return m_capacity - count() >= more; }
    void reserve(uint32_t rows);
    uint32_t append(std::span<const Entity> entities, Stamp stamp);
    uint32_t append(Entity entity, const Stamp& stamp) // room is there
    {
        const uint32_t row = count();
        push(entity);
        markStructural(row, stamp);
        return row;
    }
    // The same where count() lies in `window`, and its version is that of now.
    void push(Entity entity)
    {
        m_entities[count()] = entity;
        ++m_shape;
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
    void trim(); // gives back what belongs to no row

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
        std::byte* const* columns;
        size_t row; // within the block
        const int16_t* columnOf;
    };
    [[nodiscard]] RowPlace rowPlace(uint32_t row) const
    {
        return {columnsAt(row), rowInBlock(row), m_columnOf.data()};
    }

    // Change marks. `column` is the first column of a component.
    void markRow(uint32_t column, uint32_t row, const Stamp& stamp)
    {
        ColumnVersions& versions = startVersion(column, stamp);
        m_versions[versionPlace(column, row)] = stamp.version;
        if (versions.rows != nullptr)
            versions.rows->mark(row);
    }
    // markRow() for a component known to have bits per row, or none. False, and nothing done, if it
    // is the first of its column in this version: that takes longer, and wants a function of its
    // own. No other branches: rows written by id come from anywhere.
    template <bool kRowChanges>
    [[nodiscard]] bool markAgain(uint32_t column, uint32_t row, const Stamp& stamp)
    {
        const ColumnVersions& versions = m_columnVersions[column];
        if (newest(versions) != stamp.version)
            return false;
        m_versions[versionPlace(column, row)] = stamp.version;
        if constexpr (kRowChanges)
            versions.rows->mark(row);
        return true;
    }
    void markRows(uint32_t column, uint32_t row, uint32_t count, const Stamp& stamp);
    // All rows. Without bits per row, one store, however many segments there are: to allVersion().
    template <bool kRowChanges>
    void markAll(uint32_t column, Stamp stamp)
    {
        if constexpr (kRowChanges)
            return markRows(column, 0, count(), stamp);
        m_allVersions[column] = stamp.version;
    }
    [[nodiscard]] uint64_t version(uint32_t column, uint32_t segment) const
    {
        const uint64_t own = m_versions[size_t{segment} * m_columnCount + column];
        return std::max(own, m_allVersions[column]);
    }
    // The newest of all segments.
    [[nodiscard]] uint64_t version(uint32_t column) const
    {
        return std::max(newest(m_columnVersions[column]), m_allVersions[column]);
    }
    // When all rows were last marked at once. Stays where it is.
    [[nodiscard]] uint64_t& allVersion(uint32_t column) { return m_allVersions[column]; }
    // Rows that may have changed after `since`, in segments whose version is newer: see RowChanges.
    // All of them for a component that did not opt in.
    [[nodiscard]] ChangedRows changedRows(uint32_t column, uint64_t since) const
    {
        const RowChanges* const rows = m_columnVersions[column].rows;
        return rows == nullptr ? ChangedRows{~uint64_t{0}} : rows->changed(since);
    }

    // Disabled rows (World::setEnabled). A row that is enabled again counts as changed: readers
    // that skipped it may have missed something.
    [[nodiscard]] const DisabledRows& disabled() const { return m_disabled; }
    void setDisabled(uint32_t row, bool disabled, Stamp stamp)
    {
        if (!disabled && m_disabled.test(row))
            markStructural(row, 1, stamp);
        m_disabled.set(row, m_segmentShift, disabled);
        setLayout();
    }
    // `more` rows may then be appended and disabled without allocation.
    void makeDisabledRoom(uint32_t more) { m_disabled.makeRoom(count() + more, m_segmentShift); }

    [[nodiscard]] size_t blockBytes() const { return m_blocks.size() * m_blockBytes; }
    [[nodiscard]] size_t valueBytes() const { return size_t{count()} * m_rowBytes; }
    [[nodiscard]] size_t bookBytes() const;

private:
    [[nodiscard]] uint32_t columnGapAt(uint32_t shift) const;
    [[nodiscard]] size_t blockBytesAt(uint32_t shift) const;
    void setBlockShift(uint32_t shift);
    void addBlock();
    void setColumnsAt(size_t block);
    void setLayout()
    {
        const uint32_t layout = m_blocks.size() == 1 && m_disabled.count() == 0 ? m_layouts : 0;
        m_shape = uint64_t{layout} << 32 | count();
    }
    void growFirstBlock();
    void destroyRow(uint32_t row);
    void markStructural(uint32_t row, uint32_t count, Stamp stamp);
    // The same for one row. Rows come and go one after the other in one segment: if all its columns
    // have the version already, only the row bits are left to set.
    void markStructural(uint32_t row, const Stamp& stamp)
    {
        const uint32_t segment = row >> m_segmentShift;
        if (segment != m_stampedSegment || stamp.version != m_stampedVersion)
            return markStructural(row, 1, stamp);
        for (RowChanges& changes : m_rowChanges)
            changes.mark(row);
    }
    struct ColumnVersions {
        uint64_t newest = 0;        // of segments marked one by one; read and written atomically
        RowChanges* rows = nullptr; // on the first lane of a component that has bits per row
    };
    [[nodiscard]] static uint64_t newest(const ColumnVersions& versions)
    {
        return __atomic_load_n(&versions.newest, __ATOMIC_ACQUIRE);
    }
    // To call before each mark. Different columns, and different segments of one column, may be
    // marked at once; a column is only ever written under one version at a time.
    ColumnVersions& startVersion(uint32_t column, const Stamp& stamp)
    {
        ColumnVersions& versions = m_columnVersions[column];
        if (newest(versions) < stamp.version) [[unlikely]]
            startVersion(versions, stamp);
        return versions;
    }
    static void startVersion(ColumnVersions& versions, const Stamp& stamp);
    [[nodiscard]] size_t versionPlace(uint32_t column, uint32_t row) const
    {
        return size_t{row >> m_segmentShift} * m_columnCount + column;
    }

    // Walks over all rows touch the first two cache lines alone.
    std::vector<Entity> m_entities;      // [row], as many as there is room for
    std::vector<std::byte*> m_columnsAt; // [block][column]
    uint64_t m_shape = 0;
    uint32_t m_blockShift = 0; // log2 of the rows in a block, as of now
    uint32_t m_blockMask = 0;  // blockRows() - 1
    uint32_t m_segmentShift = 0;
    uint32_t m_segmentMask = 0; // segmentRows() - 1
    uint16_t m_columnCount = 0;
    uint32_t m_capacity = 0;                      // rows that have room in everything
    std::vector<ColumnVersions> m_columnVersions; // [column]
    DisabledRows m_disabled;
    std::vector<uint64_t> m_allVersions;  // [column]; 0 with row changes
    std::vector<uint64_t> m_versions;     // [segment][column], of the last write; first lanes only
    std::vector<RowChanges> m_rowChanges; // of the columns that have them
    uint32_t m_stampedSegment = kNone;    // markStructural's last
    uint64_t m_stampedVersion = 0;
    std::vector<Column> m_columns;
    std::vector<std::byte*> m_blocks; // owned, all of one size
    std::array<int16_t, kMaxComponents> m_columnOf;
    ComponentMask m_mask;
    uint32_t m_index;
    uint32_t m_rowBytes = 0;
    uint32_t m_layouts = 0; // so far
    bool m_hasLife = false; // some column is not trivially copyable
    size_t m_blockBytes = 0;

public:
    // Kept here for World. The EntityTable's pages of the rows. And where adding or removing a
    // ComponentSet leads, by slot; null until asked for the first time.
    std::vector<uint32_t> pages;
    std::vector<Archetype*> withSet, withoutSet;

    // Rows of one segment, so of one block and one page, that need no more than push(): there is
    // room, and all columns of the segment have the version already.
    struct Window {
        uint32_t first = 0;
        uint32_t rows = 0;     // 0: closed, as where rows have change bits to set
        uint32_t rowPlace = 0; // EntityTable's place of a row, less the row
        uint64_t version = 0;
        std::byte* const* columns = nullptr; // columnsAt(first)
    };
    Window window;
    void openWindow(uint32_t row, const Stamp& stamp) // after append()
    {
        const uint32_t first = row & ~m_segmentMask;
        if (m_rowChanges.empty())
            window = {first, std::min(segmentRows(), m_capacity - first),
                      (pages[row >> kPageShift] << kPageShift) - (row & ~(kPageRows - 1)),
                      stamp.version, columnsAt(row)};
    }
};

} // namespace penumbra::ecs
