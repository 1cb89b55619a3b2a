#include "runtime/ecs/command_buffer.h"

namespace penumbra::ecs {

void CommandBuffer::record(Entity entity, ComponentId id, Kind kind, const void* value,
                           size_t bytes)
{
    m_ops.emplace_back(entity, static_cast<uint32_t>(m_values.size()), id, kind);
    if (bytes > 0) {
        const auto* source = static_cast<const std::byte*>(value);
        m_values.insert(m_values.end(), source, source + bytes);
    }
}

void CommandBuffer::clear()
{
    m_ops.clear();
    m_values.clear();
    m_created = 0;
    ++m_epoch;
}

} // namespace penumbra::ecs
