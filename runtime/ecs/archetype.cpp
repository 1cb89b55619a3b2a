#include "runtime/ecs/archetype.h"

#include "runtime/ecs/copy_value.h"

#include <algorithm>
#include <cstring>

namespace penumbra::ecs {

namespace {

// Columns of 2^n rows would all start at one cache set, so they lie apart. Not by little: a load
// whose address equals that of a store under way in its low 12 bits waits for it (4 KiB aliasing),
// and the processor works up to 30 vectors ahead. Eight lines keep the next column out of reach.
constexpr uint32_t kColumnGap = 8 * kMaxAlignment;

// log2 of the rows of rowBytes that fit in `bytes`, at least four, at most as many as 4-byte rows.
uint32_t rowShift(uint32_t bytes, uint32_t rowBytes)
{
    return std::max<uint32_t>(std::bit_width(bytes / std::max(rowBytes, 4u)), 3) - 1;
}

std::byte* allocateBlock(size_t bytes)
{
    return static_cast<std::byte*>(
        ::operator new (std::max<size_t>(bytes, 1), std::align_val_t{kMaxAlignment}));
}

void freeBlock(std::byte* block)
{
    ::operator delete (block, std::align_val_t{kMaxAlignment});
}

} // namespace

Archetype::Archetype(uint32_t index, const ComponentMask& mask) : m_mask(mask), m_index(index)
{
    m_columnOf.fill(-1);
    std::vector<ComponentId> order;
    mask.forEach([&](ComponentId id) {
        if (componentInfo(id).bytes > 0)
            order.push_back(id);
    });
    // Falling alignment: then every prefix sum is aligned for the column that starts there.
    std::stable_sort(order.begin(), order.end(), [](ComponentId a, ComponentId b) {
        return componentInfo(a).laneAlignment > componentInfo(b).laneAlignment;
    });
    for (const ComponentId id : order)
        m_rowBytes += componentInfo(id).bytes;
    m_segmentShift = rowShift(kSegmentBytes, m_rowBytes);

    uint32_t prefix = 0;
    for (const ComponentId id : order) {
        const ComponentInfo& info = componentInfo(id);
        m_columnOf[id] = static_cast<int16_t>(m_columns.size());
        const uint32_t laneBytes = info.bytes / info.laneCount;
        for (uint32_t lane = 0; lane < info.laneCount; ++lane, prefix += laneBytes)
            m_columns.push_back(
                {id, static_cast<uint16_t>(lane), laneBytes, prefix, 0, -1, info.life});
        m_hasLife = m_hasLife || info.life != nullptr;
        if (info.rowChanges) {
            m_columns[m_columnOf[id]].rowChanges = static_cast<int32_t>(m_rowChanges.size());
            m_rowChanges.emplace_back(segmentRows());
        }
    }
    m_columnVersions.resize(m_columns.size());
    m_blockShift = std::min(rowShift(kFirstBlockBytes, m_rowBytes), m_segmentShift);
    m_blockBytes = layOutColumns(m_columns, m_blockShift);
}

Archetype::~Archetype()
{
    for (uint32_t row = 0; m_hasLife && row < count(); ++row)
        destroyRow(row);
    for (std::byte* block : m_blocks)
        freeBlock(block);
}

// The columns' offsets in a block of 2^blockShift rows. Returns the block's bytes.
size_t Archetype::layOutColumns(std::vector<Column>& columns, uint32_t blockShift) const
{
    const uint32_t gap = blockShift >= m_segmentShift ? kColumnGap : 0; // small blocks stay small
    for (uint32_t i = 0; i < columns.size(); ++i)
        columns[i].offset = (columns[i].prefix << blockShift) + i * gap;
    return (size_t{m_rowBytes} << blockShift) + columns.size() * gap;
}

void Archetype::growFirstBlock()
{
    // x4 up to one segment, then the full block: 1, 4, 16, 128 KiB.
    const uint32_t blockShift = m_blockShift < m_segmentShift
                                    ? std::min(m_blockShift + 2, m_segmentShift)
                                    : m_segmentShift + kBlockSegmentShift;
    std::vector<Column> columns = m_columns;
    const size_t bytes = layOutColumns(columns, blockShift);
    if (!m_blocks.empty()) {
        std::byte* const block = allocateBlock(bytes);
        const uint32_t rows = count();
        for (size_t i = 0; i < columns.size(); ++i) {
            std::byte* const to = block + columns[i].offset;
            std::byte* const from = m_blocks[0] + m_columns[i].offset;
            if (columns[i].life != nullptr)
                columns[i].life->relocate(to, from, rows);
            else
                std::memcpy(to, from, size_t{rows} * columns[i].bytes);
        }
        freeBlock(m_blocks[0]);
        m_blocks[0] = block;
    }
    m_columns = std::move(columns);
    m_blockShift = blockShift;
    m_blockBytes = bytes;
}

void Archetype::reserve(uint32_t rows)
{
    if (rows <= m_capacity)
        return;
    const uint32_t full = m_segmentShift + kBlockSegmentShift;
    while (rows > blockRows() && m_blockShift < full)
        growFirstBlock();
    while (rows > m_blocks.size() << m_blockShift) {
        m_blocks.reserve(m_blocks.size() + 1);
        m_blocks.push_back(allocateBlock(m_blockBytes));
    }
    const uint32_t segments = (rows + segmentRows() - 1) >> m_segmentShift;
    if (m_versions.size() < size_t{segments} * m_columns.size()) {
        for (RowChanges& changes : m_rowChanges)
            changes.resize(segments);
        m_versions.resize(size_t{segments} * m_columns.size());
    }
    reserveSparingly(m_entities, rows);
    m_capacity = static_cast<uint32_t>(
        std::min({m_blocks.size() << m_blockShift, size_t{segments} << m_segmentShift,
                  m_entities.capacity()}));
}

uint32_t Archetype::append(std::span<const Entity> entities, Stamp stamp)
{
    const uint32_t row = count();
    const auto added = static_cast<uint32_t>(entities.size());
    reserve(row + added);
    m_entities.insert(m_entities.end(), entities.begin(), entities.end());
    markStructural(row, added, stamp);
    return row;
}

void Archetype::markStructural(uint32_t row, uint32_t added, Stamp stamp)
{
    for (const uint32_t end = row + added; row < end;) {
        const uint32_t first = row & (segmentRows() - 1);
        const uint32_t length = std::min(segmentRows() - first, end - row);
        for (uint32_t column = 0; column < m_columns.size(); ++column)
            if (m_columns[column].lane == 0)
                markRows(column, row >> m_segmentShift, first, length, stamp);
        m_stampedSegment = row >> m_segmentShift;
        row += length;
    }
    m_stampedVersion = stamp.version;
}

void Archetype::destroyRow(uint32_t row)
{
    for (uint32_t column = 0; column < m_columns.size(); ++column)
        if (const ComponentLife* life = m_columns[column].life)
            life->destroy(at(column, row), 1);
}

void Archetype::markAllRows(uint32_t column, Stamp stamp)
{
    for (uint32_t segment = 0; segment < segmentCount(); ++segment)
        markRows(column, segment, 0, std::min(segmentRows(), count() - (segment << m_segmentShift)),
                 stamp);
}

Entity Archetype::closeGap(uint32_t row, Stamp stamp)
{
    const uint32_t last = count() - 1;
    Entity moved;
    if (row != last) {
        moved = m_entities[last];
        m_entities[row] = moved;
        std::byte* const to = m_blocks[row >> m_blockShift];
        const std::byte* const from = m_blocks[last >> m_blockShift];
        const size_t toRow = row & (blockRows() - 1), fromRow = last & (blockRows() - 1);
        for (const Column& c : m_columns) {
            if (c.life != nullptr) [[unlikely]]
                c.life->relocate(to + c.offset + toRow * c.bytes,
                                 const_cast<std::byte*>(from) + c.offset + fromRow * c.bytes, 1);
            else
                copyValue(to + c.offset + toRow * c.bytes, from + c.offset + fromRow * c.bytes,
                          c.bytes);
        }
        markStructural(row, stamp);
    }
    m_disabled.removeRow(row, last, m_segmentShift);
    m_entities.pop_back();
    return moved;
}

void Archetype::moveRow(uint32_t row, Archetype& source, uint32_t sourceRow)
{
    const RowPlace to = rowPlace(row);
    const RowPlace from = source.rowPlace(sourceRow);
    for (const Column& c : source.m_columns) {
        std::byte* const value = from.block + c.offset + from.row * c.bytes;
        const int32_t first = to.columnOf[c.component];
        if (first < 0) {
            if (c.life != nullptr) [[unlikely]]
                c.life->destroy(value, 1);
            continue;
        }
        std::byte* const place = to.block + to.columns[first + c.lane].offset + to.row * c.bytes;
        if (c.life != nullptr) [[unlikely]]
            c.life->relocate(place, value, 1);
        else
            copyValue(place, value, c.bytes);
    }
}

void Archetype::moveRows(uint32_t row, Archetype& source, std::span<const uint32_t> sourceRows)
{
    for (uint32_t from = 0; from < source.m_columns.size(); ++from) {
        const Column& c = source.m_columns[from];
        const int32_t column = columnOf(c.component);
        if (c.life != nullptr) {
            for (uint32_t i = 0; i < sourceRows.size(); ++i)
                if (column < 0)
                    c.life->destroy(source.at(from, sourceRows[i]), 1);
                else
                    c.life->relocate(at(column, row + i), source.at(from, sourceRows[i]), 1);
        } else if (column >= 0) {
            for (uint32_t i = 0; i < sourceRows.size(); ++i)
                copyValue(at(column + c.lane, row + i), source.at(from, sourceRows[i]), c.bytes);
        }
    }
}

void Archetype::trim()
{
    const size_t blocks = (size_t{count()} + blockRows() - 1) >> m_blockShift;
    for (; m_blocks.size() > blocks; m_blocks.pop_back())
        freeBlock(m_blocks.back());
    m_blocks.shrink_to_fit();
    m_entities.shrink_to_fit();
    m_capacity = static_cast<uint32_t>(
        std::min({size_t{m_capacity}, m_blocks.size() << m_blockShift, m_entities.capacity()}));
}

size_t Archetype::bookBytes() const
{
    size_t bytes = sizeof(*this) + m_entities.capacity() * sizeof(Entity) +
                   m_versions.capacity() * sizeof(uint64_t) +
                   m_columns.capacity() * sizeof(Column) +
                   m_blocks.capacity() * sizeof(std::byte*) + pages.capacity() * sizeof(uint32_t) +
                   m_columnVersions.capacity() * sizeof(uint64_t) + m_disabled.bytes() +
                   (withSet.capacity() + withoutSet.capacity()) * sizeof(Archetype*);
    for (const RowChanges& changes : m_rowChanges)
        bytes += changes.bytes();
    return bytes;
}

} // namespace penumbra::ecs
