#include "runtime/ecs/archetype.h"

#include "runtime/assert.h"

#include <algorithm>
#include <cstring>

namespace penumbra::ecs {

namespace {

// Columns of 2^n rows would all start at one cache set, and a store to one column would look to the
// processor like a load from the next (4 KiB aliasing). An odd number of lines apart avoids both.
constexpr uint32_t kColumnGap = 5 * kMaxAlignment;

// log2 of the rows of rowBytes that fit in `bytes`, at least four, at most as many as 4-byte rows.
uint32_t rowShift(uint32_t bytes, uint32_t rowBytes)
{
    return std::max<uint32_t>(std::bit_width(bytes / std::max(rowBytes, 4u)), 3) - 1;
}

// A copy of known size is one or two moves; these sizes are nearly all components and lanes.
inline void copyValue(std::byte* to, const std::byte* from, size_t bytes)
{
    if (bytes == 4)
        std::memcpy(to, from, 4);
    else if (bytes == 12)
        std::memcpy(to, from, 12);
    else if (bytes == 16)
        std::memcpy(to, from, 16);
    else
        std::memcpy(to, from, bytes);
}

template <size_t kBytes>
void copyStrided(std::byte* to, const std::byte* from, size_t fromStride, size_t n, size_t bytes)
{
    const size_t size = kBytes > 0 ? kBytes : bytes;
    for (; n > 0; --n, to += size, from += fromStride)
        std::memcpy(to, from, size);
}

// n values of `bytes`, side by side, from places fromStride apart.
void copyValues(std::byte* to, const std::byte* from, size_t fromStride, size_t n, size_t bytes)
{
    switch (bytes) {
    case 4:
        return copyStrided<4>(to, from, fromStride, n, bytes);
    case 12:
        return copyStrided<12>(to, from, fromStride, n, bytes);
    case 16:
        return copyStrided<16>(to, from, fromStride, n, bytes);
    default:
        return copyStrided<0>(to, from, fromStride, n, bytes);
    }
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
            m_columns.push_back({id, static_cast<uint16_t>(lane), laneBytes, prefix, 0, -1});
        if (info.rowChanges) {
            m_columns[m_columnOf[id]].rowChanges = static_cast<int32_t>(m_rowChanges.size());
            m_rowChanges.emplace_back(segmentRows());
        }
    }
    layOutBlock(std::min(rowShift(kFirstBlockBytes, m_rowBytes), m_segmentShift));
}

void Archetype::layOutBlock(uint32_t blockShift)
{
    m_blockShift = blockShift;
    const uint32_t gap = blockShift >= m_segmentShift ? kColumnGap : 0; // small blocks stay small
    for (uint32_t i = 0; i < m_columns.size(); ++i)
        m_columns[i].offset = (m_columns[i].prefix << blockShift) + i * gap;
    m_blockBytes = (size_t{m_rowBytes} << blockShift) + m_columns.size() * gap;
}

Archetype::Block Archetype::allocateBlock() const
{
    return Block(static_cast<std::byte*>(
        ::operator new (std::max<size_t>(m_blockBytes, 1), std::align_val_t{kMaxAlignment})));
}

void Archetype::growFirstBlock()
{
    const Block old = m_blocks.empty() ? nullptr : std::move(m_blocks[0]);
    const std::vector<Column> before = m_columns;
    const uint32_t rows = std::min(count(), blockRows());
    // x4 up to one segment, then the full block: 1, 4, 16, 128 KiB.
    layOutBlock(m_blockShift < m_segmentShift ? std::min(m_blockShift + 2, m_segmentShift)
                                              : m_segmentShift + kBlockSegmentShift);
    if (!old)
        return;
    m_blocks[0] = allocateBlock();
    for (size_t i = 0; i < m_columns.size(); ++i)
        std::memcpy(m_blocks[0].get() + m_columns[i].offset, old.get() + before[i].offset,
                    size_t{rows} * before[i].bytes);
}

void Archetype::reserve(uint32_t rows)
{
    const uint32_t full = m_segmentShift + kBlockSegmentShift;
    while (rows > blockRows() && m_blockShift < full)
        growFirstBlock();
    while (rows > m_blocks.size() << m_blockShift)
        m_blocks.push_back(allocateBlock());
    const uint32_t segments = (rows + segmentRows() - 1) >> m_segmentShift;
    if (m_versions.size() < size_t{segments} * m_columns.size()) {
        m_versions.resize(size_t{segments} * m_columns.size());
        for (RowChanges& changes : m_rowChanges)
            changes.resize(segments);
    }
}

uint32_t Archetype::append(std::span<const Entity> entities, Stamp stamp)
{
    const uint32_t row = count();
    const auto added = static_cast<uint32_t>(entities.size());
    if (added == 1) {
        const bool newSegment = (row & (segmentRows() - 1)) == 0;
        if (newSegment || row == m_blocks.size() << m_blockShift)
            reserve(row + 1);
        m_entities.push_back(entities[0]);
        markStructural(row, stamp);
        return row;
    }
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

Entity Archetype::removeRow(uint32_t row, Stamp stamp)
{
    const uint32_t last = count() - 1;
    Entity moved;
    if (row != last) {
        moved = m_entities[last];
        m_entities[row] = moved;
        for (uint32_t column = 0; column < m_columns.size(); ++column)
            copyValue(at(column, row), at(column, last), m_columns[column].bytes);
        markStructural(row, stamp);
    }
    m_disabled.removeRow(row, last, m_segmentShift);
    m_entities.pop_back();
    return moved;
}

void Archetype::copyRow(uint32_t row, const Archetype& source, uint32_t sourceRow)
{
    for (uint32_t column = 0; column < m_columns.size(); ++column) {
        const Column& c = m_columns[column];
        if (const int32_t from = source.columnOf(c.component); from >= 0)
            copyValue(at(column, row), source.at(from + c.lane, sourceRow), c.bytes);
    }
}

void Archetype::copyRows(uint32_t row, const Archetype& source,
                         std::span<const uint32_t> sourceRows)
{
    for (uint32_t column = 0; column < m_columns.size(); ++column) {
        const Column& c = m_columns[column];
        const int32_t from = source.columnOf(c.component);
        if (from < 0)
            continue;
        for (uint32_t i = 0; i < sourceRows.size(); ++i)
            copyValue(at(column, row + i), source.at(from + c.lane, sourceRows[i]), c.bytes);
    }
}

void Archetype::read(ComponentId id, uint32_t row, void* value) const
{
    const ComponentInfo& info = componentInfo(id);
    for (uint32_t lane = 0; info.bytes > 0 && lane < info.laneCount; ++lane) {
        const uint32_t column = m_columnOf[id] + lane;
        const uint32_t bytes = m_columns[column].bytes;
        std::memcpy(static_cast<std::byte*>(value) + size_t{lane} * bytes, at(column, row), bytes);
    }
}

void Archetype::write(ComponentId id, uint32_t row, const void* value)
{
    const auto* source = static_cast<const std::byte*>(value);
    for (int32_t column = m_columnOf[id];
         column >= 0 && column < static_cast<int32_t>(m_columns.size()) &&
         m_columns[column].component == id;
         ++column) {
        copyValue(at(column, row), source, m_columns[column].bytes);
        source += m_columns[column].bytes;
    }
}

void Archetype::fill(ComponentId id, uint32_t row, uint32_t count, const void* values,
                     size_t stride)
{
    const ComponentInfo& info = componentInfo(id);
    const auto* source = static_cast<const std::byte*>(values);
    for (const uint32_t end = row + count; info.bytes > 0 && row < end;) {
        const uint32_t length = std::min(blockRows() - (row & (blockRows() - 1)), end - row);
        for (uint32_t lane = 0; lane < info.laneCount; ++lane) {
            const uint32_t column = m_columnOf[id] + lane;
            const uint32_t bytes = m_columns[column].bytes;
            copyValues(at(column, row), source + size_t{lane} * bytes, stride, length, bytes);
        }
        source += length * stride;
        row += length;
    }
}

void Archetype::trim()
{
    m_blocks.resize((size_t{count()} + blockRows() - 1) >> m_blockShift);
    m_blocks.shrink_to_fit();
    m_entities.shrink_to_fit();
}

size_t Archetype::bookBytes() const
{
    size_t bytes = sizeof(*this) + m_entities.capacity() * sizeof(Entity) +
                   m_versions.capacity() * sizeof(uint64_t) +
                   m_columns.capacity() * sizeof(Column) + m_blocks.capacity() * sizeof(Block) +
                   m_disabled.bytes() +
                   (withSet.capacity() + withoutSet.capacity()) * sizeof(Archetype*);
    for (const RowChanges& changes : m_rowChanges)
        bytes += changes.bytes();
    return bytes;
}

} // namespace penumbra::ecs
