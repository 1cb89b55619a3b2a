#include "runtime/ecs/snapshot_sink.h"

#include "runtime/ecs/snapshot_format.h"

#include <algorithm>
#include <cstring>
#define XXH_INLINE_ALL
#include <xxhash.h>

namespace penumbra::ecs {

struct HashSink::State {
    XXH64_state_t hash;
};

void MemorySink::write(const void* data, size_t count)
{
    const auto* from = static_cast<const std::byte*>(data);
    if (count > 0)
        bytes.insert(bytes.end(), from, from + count);
}

HashSink::HashSink() : m_state(std::make_unique<State>())
{
    XXH64_reset(&m_state->hash, 0);
}

HashSink::~HashSink() = default;

void HashSink::write(const void* data, size_t count)
{
    const auto* from = static_cast<const std::byte*>(data);
    while (count > 0) {
        const size_t part = std::min(count, m_small.size() - m_used);
        std::memcpy(m_small.data() + m_used, from, part);
        m_used += part;
        from += part;
        count -= part;
        if (m_used == m_small.size())
            flush();
    }
}

uint64_t HashSink::value()
{
    flush();
    return XXH64_digest(&m_state->hash);
}

void HashSink::flush()
{
    XXH64_update(&m_state->hash, m_small.data(), m_used);
    m_used = 0;
}

uint64_t snapshotChecksum(std::span<const std::byte> bytes)
{
    return XXH64(bytes.data(), bytes.size(), 0);
}

} // namespace penumbra::ecs
