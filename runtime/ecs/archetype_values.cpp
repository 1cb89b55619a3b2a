// Archetype: whole values by type, whatever their lanes.
#include "runtime/ecs/archetype.h"
#include "runtime/ecs/copy_value.h"

#include <algorithm>

namespace penumbra::ecs {

namespace {

template <size_t kBytes>
void copyStrided(std::byte* to, const std::byte* from, size_t fromStride, size_t n, size_t bytes)
{
    const size_t size = kBytes > 0 ? kBytes : bytes;
    for (; n > 0; --n, to += size, from += fromStride)
        std::memcpy(to, from, size);
}

// Bytes. The processor's own prefetching stops at the end of each page of memory.
constexpr size_t kFillAhead = 1024;

template <class Word>
void repeatValue(std::byte* to, const std::byte* from, size_t n)
{
    Word word;
    std::memcpy(&word, from, sizeof(word));
    constexpr size_t kLine = 64 / sizeof(word);
    size_t i = 0;
    for (; i + kLine <= n; i += kLine) {
        __builtin_prefetch(to + i * sizeof(word) + kFillAhead, 1);
        for (size_t k = 0; k < kLine; ++k)
            std::memcpy(to + (i + k) * sizeof(word), &word, sizeof(word));
    }
    for (; i < n; ++i)
        std::memcpy(to + i * sizeof(word), &word, sizeof(word));
}

// n values of `bytes`, side by side, from places fromStride apart; 0 repeats one.
void copyValues(std::byte* to, const std::byte* from, size_t fromStride, size_t n, size_t bytes)
{
    if (fromStride == bytes) {
        std::memcpy(to, from, n * bytes);
    } else if (fromStride == 0 && bytes == 4) {
        repeatValue<uint32_t>(to, from, n);
    } else if (fromStride == 0 && bytes == 16) {
        repeatValue<std::array<uint64_t, 2>>(to, from, n);
    } else if (bytes == 4) {
        copyStrided<4>(to, from, fromStride, n, bytes);
    } else if (bytes == 12) {
        copyStrided<12>(to, from, fromStride, n, bytes);
    } else if (bytes == 16) {
        copyStrided<16>(to, from, fromStride, n, bytes);
    } else {
        copyStrided<0>(to, from, fromStride, n, bytes);
    }
}

using Word [[gnu::may_alias]] = uint32_t; // of whatever type

// x, y, z of n values into three columns, in one walk over the source.
void copyLanes3(Word* __restrict x, Word* __restrict y, Word* __restrict z,
                const Word* __restrict from, size_t n)
{
    for (size_t i = 0; i < n; ++i) {
        x[i] = from[3 * i];
        y[i] = from[3 * i + 1];
        z[i] = from[3 * i + 2];
    }
}

} // namespace

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
    if (m_columnOf[id] < 0)
        return;
    const ComponentInfo& info = componentInfo(id);
    const auto* source = static_cast<const std::byte*>(values);
    for (uint32_t done = 0; done < count;) {
        const uint32_t at0 = row + done;
        const uint32_t length = std::min(blockRows() - (at0 & (blockRows() - 1)), count - done);
        if (info.life != nullptr) {
            try {
                (stride == 0 ? info.life->repeat : info.life->copy)(at(m_columnOf[id], at0), source,
                                                                    length);
            } catch (...) {
                destroyValues(id, row, done);
                throw;
            }
        }
        if (const auto first = static_cast<uint32_t>(m_columnOf[id]);
            info.laneCount == 3 && m_columns[first].bytes == 4 && stride == 12) {
            const auto words = [&](uint32_t lane) {
                return reinterpret_cast<Word*>(at(first + lane, at0));
            };
            copyLanes3(words(0), words(1), words(2), reinterpret_cast<const Word*>(source), length);
            source += length * stride;
            done += length;
            continue;
        }
        for (uint32_t lane = 0; info.life == nullptr && lane < info.laneCount; ++lane) {
            const uint32_t column = m_columnOf[id] + lane;
            const uint32_t bytes = m_columns[column].bytes;
            copyValues(at(column, at0), source + size_t{lane} * bytes, stride, length, bytes);
        }
        source += length * stride;
        done += length;
    }
}

void Archetype::destroyValues(ComponentId id, uint32_t row, uint32_t count)
{
    const int32_t column = m_columnOf[id];
    for (const uint32_t end = row + count; column >= 0 && row < end; ++row)
        m_columns[column].life->destroy(at(column, row), 1);
}

void Archetype::moveIn(ComponentId id, uint32_t row, void* value, bool over)
{
    const int32_t column = m_columnOf[id];
    const ComponentLife& life = *m_columns[column].life;
    if (over)
        life.destroy(at(column, row), 1);
    life.move(at(column, row), value);
}

} // namespace penumbra::ecs
