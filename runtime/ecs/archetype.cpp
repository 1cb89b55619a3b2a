#include "runtime/ecs/archetype.h"

#include "runtime/ecs/copy_value.h"

#include <algorithm>
#include <cstring>
#include <mutex>
#include <utility>

namespace penumbra::ecs {

namespace {

// Columns of 2^n rows would all start at one cache set, so they lie apart. Not by little: a load
// whose address equals that of a store under way in its low 12 bits waits for it (4 KiB aliasing),
// and the processor works up to 30 vectors ahead, eight lines. Nor by a power of two of lines:
// where blocks are not full, columns would leave cache sets unused, all of them the same ones.
constexpr uint32_t kColumnGap = 11 * kMaxAlignment;

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
    std::sort(order.begin(), order.end(), [](ComponentId a, ComponentId b) {
        return columnsBefore(componentInfo(a).laneAlignment, componentInfo(a).name,
                             componentInfo(b).laneAlignment, componentInfo(b).name);
    });
    for (const ComponentId id : order)
        m_rowBytes += componentInfo(id).bytes;
    m_segmentShift = rowShift(kSegmentBytes, m_rowBytes);
    m_segmentMask = segmentRows() - 1;

    uint32_t prefix = 0;
    for (const ComponentId id : order) {
        const ComponentInfo& info = componentInfo(id);
        m_columnOf[id] = static_cast<int16_t>(m_columns.size());
        const uint32_t laneBytes = info.bytes / info.laneCount;
        for (uint32_t lane = 0; lane < info.laneCount; ++lane, prefix += laneBytes)
            m_columns.push_back({id, static_cast<uint16_t>(lane), laneBytes, prefix, info.life});
        m_hasLife = m_hasLife || info.life != nullptr;
    }
    m_columnCount = static_cast<uint16_t>(m_columns.size());
    m_columnVersions.resize(m_columns.size());
    m_allVersions.resize(m_columns.size());
    m_rowChanges.reserve(order.size()); // they stay where they are
    for (const ComponentId id : order)
        if (componentInfo(id).rowChanges)
            m_columnVersions[m_columnOf[id]].rows = &m_rowChanges.emplace_back(m_segmentShift);
    setBlockShift(std::min(rowShift(kFirstBlockBytes, m_rowBytes), m_segmentShift));
}

Archetype::~Archetype()
{
    for (uint32_t row = 0; m_hasLife && row < count(); ++row)
        destroyRow(row);
    for (std::byte* block : m_blocks)
        freeBlock(block);
}

// Bytes between the columns of a block of 2^shift rows: small blocks stay small.
uint32_t Archetype::columnGapAt(uint32_t shift) const
{
    return shift >= m_segmentShift ? kColumnGap : 0;
}

size_t Archetype::blockBytesAt(uint32_t shift) const
{
    return (size_t{m_rowBytes} << shift) + m_columns.size() * columnGapAt(shift);
}

void Archetype::setBlockShift(uint32_t shift)
{
    m_blockShift = shift;
    m_blockMask = (1u << shift) - 1;
    m_blockBytes = blockBytesAt(shift);
}

void Archetype::setColumnsAt(size_t block)
{
    const size_t gap = columnGapAt(m_blockShift);
    for (size_t i = 0; i < m_columns.size(); ++i)
        m_columnsAt[block * m_columns.size() + i] =
            m_blocks[block] + (size_t{m_columns[i].prefix} << m_blockShift) + i * gap;
    ++m_layouts;
    setLayout();
}

void Archetype::addBlock()
{
    reserveSparingly(m_blocks, m_blocks.size() + 1);
    reserveSparingly(m_columnsAt, (m_blocks.size() + 1) * m_columns.size());
    m_blocks.push_back(allocateBlock(m_blockBytes));
    m_columnsAt.resize(m_blocks.size() * m_columns.size());
    setColumnsAt(m_blocks.size() - 1);
}

void Archetype::growFirstBlock()
{
    // x4: 1, 4, 16 (one segment), 64, 256, 512 KiB.
    const uint32_t full = m_segmentShift + kBlockSegmentShift;
    const uint32_t blockShift = m_blockShift < m_segmentShift
                                    ? std::min(m_blockShift + 2, m_segmentShift)
                                    : std::min(m_blockShift + 2, full);
    if (m_blocks.empty())
        return setBlockShift(blockShift);
    const std::vector<std::byte*> from = m_columnsAt;
    std::byte* const old = std::exchange(m_blocks[0], allocateBlock(blockBytesAt(blockShift)));
    setBlockShift(blockShift); // nothing throws from here on
    setColumnsAt(0);
    for (size_t i = 0; i < m_columns.size(); ++i) {
        if (m_columns[i].life != nullptr)
            m_columns[i].life->relocate(m_columnsAt[i], from[i], count());
        else
            std::memcpy(m_columnsAt[i], from[i], size_t{count()} * m_columns[i].bytes);
    }
    freeBlock(old);
}

void Archetype::reserve(uint32_t rows)
{
    if (rows <= m_capacity)
        return;
    window.rows = 0;
    const uint32_t full = m_segmentShift + kBlockSegmentShift;
    while (rows > blockRows() && m_blockShift < full)
        growFirstBlock();
    while (rows > m_blocks.size() << m_blockShift)
        addBlock();
    const uint32_t segments = (rows + segmentRows() - 1) >> m_segmentShift;
    if (m_versions.size() < size_t{segments} * m_columns.size()) {
        for (RowChanges& changes : m_rowChanges)
            changes.resize(segments << m_segmentShift);
        m_versions.resize(size_t{segments} * m_columns.size());
    }
    if (m_entities.size() < rows) {
        reserveSparingly(m_entities, rows);
        m_entities.resize(m_entities.capacity());
    }
    m_capacity = static_cast<uint32_t>(std::min(
        {m_blocks.size() << m_blockShift, size_t{segments} << m_segmentShift, m_entities.size()}));
}

uint32_t Archetype::append(std::span<const Entity> entities, Stamp stamp)
{
    const uint32_t row = count();
    const auto added = static_cast<uint32_t>(entities.size());
    reserve(row + added);
    std::copy(entities.begin(), entities.end(), m_entities.begin() + row);
    m_shape += added;
    markStructural(row, added, stamp);
    return row;
}

void Archetype::markRows(uint32_t column, uint32_t row, uint32_t count, const Stamp& stamp)
{
    if (count == 0)
        return;
    ColumnVersions& versions = startVersion(column, stamp);
    const uint32_t end = row + count;
    for (uint32_t at = row & ~m_segmentMask; at < end; at += segmentRows())
        m_versions[versionPlace(column, at)] = stamp.version;
    if (versions.rows != nullptr)
        versions.rows->mark(row, count);
}

void Archetype::markStructural(uint32_t row, uint32_t added, Stamp stamp)
{
    if (added == 0)
        return;
    for (uint32_t column = 0; column < m_columns.size(); ++column)
        if (m_columns[column].lane == 0)
            markRows(column, row, added, stamp);
    m_stampedSegment = (row + added - 1) >> m_segmentShift;
    m_stampedVersion = stamp.version;
}

// Threads that mark segments of one column may all find that it is the first time. One lock for
// all: it is taken once per column and version.
void Archetype::startVersion(ColumnVersions& versions, const Stamp& stamp)
{
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    const uint64_t last = newest(versions);
    if (versions.rows != nullptr && last <= stamp.frameBase)
        versions.rows->startFrame(last);
    if (last < stamp.version)
        __atomic_store_n(&versions.newest, stamp.version, __ATOMIC_RELEASE);
}

void Archetype::destroyRow(uint32_t row)
{
    for (uint32_t column = 0; column < m_columns.size(); ++column)
        if (const ComponentLife* life = m_columns[column].life)
            life->destroy(at(column, row), 1);
}

Entity Archetype::closeGap(uint32_t row, Stamp stamp)
{
    const uint32_t last = count() - 1;
    Entity moved;
    if (row != last) {
        moved = m_entities[last];
        m_entities[row] = moved;
        std::byte* const* const to = columnsAt(row);
        std::byte* const* const from = columnsAt(last);
        const size_t toRow = rowInBlock(row), fromRow = rowInBlock(last);
        for (uint32_t i = 0; i < m_columnCount; ++i) {
            const Column& c = m_columns[i];
            if (c.life != nullptr) [[unlikely]]
                c.life->relocate(to[i] + toRow * c.bytes, from[i] + fromRow * c.bytes, 1);
            else
                copyValue(to[i] + toRow * c.bytes, from[i] + fromRow * c.bytes, c.bytes);
        }
        markStructural(row, stamp);
    }
    if (m_disabled.count() != 0) [[unlikely]] {
        m_disabled.removeRow(row, last, m_segmentShift);
        setLayout();
    }
    --m_shape;
    return moved;
}

void Archetype::moveRow(uint32_t row, Archetype& source, uint32_t sourceRow)
{
    const RowPlace to = rowPlace(row);
    const RowPlace from = source.rowPlace(sourceRow);
    for (uint32_t i = 0; i < source.m_columnCount; ++i) {
        const Column& c = source.m_columns[i];
        std::byte* const value = from.columns[i] + from.row * c.bytes;
        const int32_t first = to.columnOf[c.component];
        if (first < 0) {
            if (c.life != nullptr) [[unlikely]]
                c.life->destroy(value, 1);
            continue;
        }
        std::byte* const place = to.columns[first + c.lane] + to.row * c.bytes;
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
    window.rows = 0;
    const size_t blocks = (size_t{count()} + blockRows() - 1) >> m_blockShift;
    for (; m_blocks.size() > blocks; m_blocks.pop_back())
        freeBlock(m_blocks.back());
    m_blocks.shrink_to_fit();
    m_columnsAt.resize(m_blocks.size() * m_columns.size());
    m_columnsAt.shrink_to_fit();
    m_entities.resize(count());
    m_entities.shrink_to_fit();
    const uint32_t segments = segmentCount();
    m_versions.resize(size_t{segments} * m_columns.size());
    m_versions.shrink_to_fit();
    for (RowChanges& changes : m_rowChanges)
        changes.trim(segments << m_segmentShift);
    m_stampedSegment = kNone; // its versions may be gone
    m_capacity = count();
    setLayout();
}

size_t Archetype::bookBytes() const
{
    size_t bytes =
        sizeof(*this) + m_entities.capacity() * sizeof(Entity) +
        m_versions.capacity() * sizeof(uint64_t) + m_columns.capacity() * sizeof(Column) +
        (m_blocks.capacity() + m_columnsAt.capacity()) * sizeof(std::byte*) +
        pages.capacity() * sizeof(uint32_t) + m_columnVersions.capacity() * sizeof(ColumnVersions) +
        m_allVersions.capacity() * sizeof(uint64_t) + m_disabled.bytes() +
        (withSet.capacity() + withoutSet.capacity()) * sizeof(Archetype*);
    for (const RowChanges& changes : m_rowChanges)
        bytes += changes.bytes();
    return bytes;
}

} // namespace penumbra::ecs
