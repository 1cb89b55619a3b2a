// Command playback: what the commands come to, entity by entity.
#include "runtime/assert.h"
#include "runtime/ecs/command_playback.h"

#include <algorithm>

namespace penumbra::ecs {

Entity CommandPlayback::real(Entity entity, uint32_t buffer) const
{
    if (!entity.isDeferred())
        return entity;
    PENUMBRA_ASSERT(entity.generation == m_buffers[buffer]->deferredGeneration() &&
                        entity.index < m_created[buffer].size(),
                    "deferred entity {} belongs to another buffer, or to one already played",
                    entity.index);
    return m_created[buffer][entity.index];
}

void CommandPlayback::collect()
{
    PENUMBRA_ASSERT(m_buffers.size() <= UINT16_MAX, "{} command buffers in one playback",
                    m_buffers.size());
    m_created.resize(m_buffers.size());
    std::vector<uint32_t>& slotOf = m_world.m_mergeSlots; // [entity index], kNone between playbacks
    for (uint32_t b = 0; b < m_buffers.size(); ++b) {
        CommandBuffer& buffer = *m_buffers[b];
        m_created[b].reserve(buffer.m_created);
        m_world.m_entities.reserve(buffer.m_created);
        m_slots.reserve(m_slots.size() + buffer.m_created);
        for (Op& op : buffer.m_ops) {
            op.buffer = static_cast<uint16_t>(b);
            if (op.kind == Kind::create)
                m_created[b].push_back(m_world.m_entities.allocate());
            const Entity entity = real(op.target, b);
            const bool isNew = op.target.isDeferred();
            if (!isNew && !m_world.alive(entity)) {
                ++m_statistics.dropped;
                continue;
            }
            if (const size_t count = m_world.m_entities.indexCount(); count > slotOf.size()) {
                reserveSparingly(slotOf, count);
                slotOf.resize(slotOf.capacity(), kNone);
            }
            uint32_t& index = slotOf[entity.index];
            if (index == kNone) {
                index = static_cast<uint32_t>(m_slots.size());
                m_slots.push_back({entity});
                if (!isNew)
                    m_slots.back().from = m_world.place(entity).archetype;
            }
            Slot& slot = m_slots[index];
            (slot.first == nullptr ? slot.first : slot.last->next) = &op;
            slot.last = &op;
        }
        m_statistics.commands += static_cast<uint32_t>(buffer.m_ops.size());
    }
    for (const Slot& slot : m_slots)
        slotOf[slot.entity.index] = kNone;
}

// Replaces deferred entities inside a value by the real ones, where it lies.
void CommandPlayback::resolve(const Op& op)
{
    for (const uint32_t offset : componentInfo(op.component).entityFields) {
        Entity entity;
        std::memcpy(&entity, valueOf(op) + offset, sizeof(entity));
        entity = real(entity, op.buffer);
        std::memcpy(valueOf(op) + offset, &entity, sizeof(entity));
    }
}

CommandPlayback::Run& CommandPlayback::runOf(Archetype* from, Archetype* to)
{
    const auto goesThere = [&](const Run& run) { return run.from == from && run.to == to; };
    if (m_lastRun >= m_runs.size() || !goesThere(m_runs[m_lastRun])) {
        const auto found = std::find_if(m_runs.begin(), m_runs.end(), goesThere);
        m_lastRun = static_cast<uint32_t>(found - m_runs.begin());
        if (found == m_runs.end())
            m_runs.push_back({from, to, {}});
    }
    return m_runs[m_lastRun];
}

void CommandPlayback::merge(uint32_t slotIndex)
{
    Slot& slot = m_slots[slotIndex];
    ComponentMask mask = slot.from != nullptr ? slot.from->mask() : ComponentMask{};
    for (Op* op = slot.first; op != nullptr; op = op->next) {
        switch (op->kind) {
        case Kind::create:
            break;
        case Kind::enable:
        case Kind::disable:
            m_enables = true;
            break;
        case Kind::destroy:
            slot.destroyed = true;
            break;
        case Kind::set:
            if (mask.test(op->component)) {
                resolve(*op);
            } else {
                op->kind = Kind::remove; // not to be written; it is absent at this point anyway
                ++m_statistics.dropped;
            }
            break;
        case Kind::add:
            mask.set(op->component);
            resolve(*op);
            if (op->component == m_parent)
                slot.parent = op;
            break;
        case Kind::remove:
            mask.reset(op->component);
            if (op->component == m_parent) {
                slot.parent = nullptr;
                slot.parentRemoved = true;
            }
            break;
        }
    }
    if (slot.destroyed) // wins over all that is said besides
        mask = slot.from != nullptr ? slot.from->mask() : ComponentMask{};
    if (m_lastTo == nullptr || !(m_lastTo->mask() == mask))
        m_lastTo = &m_world.archetypeOf(mask);
    slot.to = m_lastTo;
    if (slot.to != slot.from)
        runOf(slot.from, slot.to).entities.push_back(slot.entity);
}

} // namespace penumbra::ecs
