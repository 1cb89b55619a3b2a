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

void CommandBuffer::freeBoxes()
{
    for (const Box& box : m_boxes)
        box.free(box.value);
    m_boxes.clear();
}

void CommandBuffer::swap(CommandBuffer& other) noexcept
{
    m_ops.swap(other.m_ops);
    m_values.swap(other.m_values);
    m_boxes.swap(other.m_boxes);
    std::swap(m_created, other.m_created);
    std::swap(m_epoch, other.m_epoch);
    std::swap(m_tag, other.m_tag);
}

void CommandBuffer::clear()
{
    freeBoxes();
    m_ops.clear();
    m_values.clear();
    m_created = 0;
    ++m_epoch;
}

} // namespace penumbra::ecs
