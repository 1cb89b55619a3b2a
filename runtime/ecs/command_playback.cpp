// Playback of command buffers, in order:
//   collect    ops -> one slot per entity; new entities get their ids, in recording order
//   merge      a slot's ops -> its final set of components; deferred entities in values -> real
//   ones move       slots sorted by (destination, source archetype); each run moves column by
//   column write      values, in recording order attach     parents; then destroys
#include "runtime/ecs/command_buffer.h"

#include "runtime/assert.h"
#include "runtime/ecs/world.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace penumbra::ecs {

class CommandPlayback {
public:
    CommandPlayback(World& world, std::span<CommandBuffer* const> buffers)
        : m_world(world), m_buffers(buffers), m_parent(componentId<Parent>())
    {}

    PlaybackStatistics run()
    {
        m_world.assertStructural();
        collect();
        for (Slot& slot : m_slots)
            merge(slot);
        move();
        for (Slot& slot : m_slots)
            write(slot);
        for (const Slot& slot : m_slots)
            attach(slot);
        for (const Slot& slot : m_slots)
            if (slot.destroyed && m_world.alive(slot.entity)) // else it went with its parent
                m_world.destroy(slot.entity);
        for (const Entity entity : m_orphans)
            if (m_world.alive(entity))
                m_world.destroy(entity);
        for (CommandBuffer* buffer : m_buffers)
            buffer->clear();
        return m_statistics;
    }

private:
    using Kind = CommandBuffer::Kind;

    struct Op {
        CommandBuffer::Op* op;
        std::byte* value;
        uint32_t buffer;
        uint32_t next = kNone; // of the same entity
    };
    struct Slot {
        Entity entity;
        uint32_t first = kNone, last = kNone; // into m_ops
        Archetype* from = nullptr;            // null: new
        Archetype* to = nullptr;
        const Op* parent = nullptr; // the op that gave its last Parent value
        bool destroyed = false;
        bool parentRemoved = false;
    };

    void collect();
    void merge(Slot& slot);
    void resolve(const Op& op);
    [[nodiscard]] Entity real(Entity entity, uint32_t buffer) const;
    void move();
    void moveRun(std::span<const uint32_t> run);
    void write(Slot& slot);
    void attach(const Slot& slot);

    World& m_world;
    std::span<CommandBuffer* const> m_buffers;
    ComponentId m_parent;
    std::vector<Op> m_ops;
    std::vector<Slot> m_slots;
    std::vector<std::vector<Entity>> m_created; // [buffer][deferred index]
    std::vector<Entity> m_orphans;
    std::vector<Entity> m_entities;                    // scratch of moveRun()
    std::vector<std::pair<uint32_t, uint32_t>> m_rows; // scratch of moveRun(): source row, slot
    Archetype* m_lastTo = nullptr;                     // most entities go where the one before went
    PlaybackStatistics m_statistics;
};

Entity CommandPlayback::real(Entity entity, uint32_t buffer) const
{
    if (!entity.isDeferred())
        return entity;
    const CommandBuffer& owner = *m_buffers[buffer];
    const uint32_t generation = owner.m_tag << 19 | (owner.m_epoch & 0x7ffff) | 1u << 31;
    PENUMBRA_ASSERT(entity.generation == generation && entity.index < m_created[buffer].size(),
                    "deferred entity {} belongs to another buffer, or to one already played",
                    entity.index);
    return m_created[buffer][entity.index];
}

void CommandPlayback::collect()
{
    size_t count = 0;
    for (const CommandBuffer* buffer : m_buffers)
        count += buffer->m_ops.size();
    m_ops.reserve(count);
    m_created.resize(m_buffers.size());
    std::vector<uint32_t>& slotOf = m_world.m_mergeSlots; // [entity index], kNone between playbacks
    for (uint32_t b = 0; b < m_buffers.size(); ++b) {
        CommandBuffer& buffer = *m_buffers[b];
        for (CommandBuffer::Op& op : buffer.m_ops) {
            if (op.kind == Kind::create)
                m_created[b].push_back(m_world.m_entities.allocate());
            const Entity entity = real(op.target, b);
            const bool isNew = op.target.isDeferred();
            if (!isNew && !m_world.alive(entity)) {
                ++m_statistics.dropped;
                continue;
            }
            if (m_world.m_entities.indexCount() > slotOf.size())
                slotOf.resize(m_world.m_entities.indexCount() * size_t{2}, kNone);
            uint32_t& slot = slotOf[entity.index];
            if (slot == kNone) {
                slot = static_cast<uint32_t>(m_slots.size());
                m_slots.push_back({entity});
                if (!isNew)
                    m_slots.back().from = m_world.place(entity).archetype;
            }
            const auto at = static_cast<uint32_t>(m_ops.size());
            m_ops.push_back({&op, buffer.m_values.data() + op.value, b});
            Slot& s = m_slots[slot];
            (s.first == kNone ? s.first : m_ops[s.last].next) = at;
            s.last = at;
        }
        m_statistics.commands += static_cast<uint32_t>(buffer.m_ops.size());
    }
    for (const Slot& slot : m_slots)
        slotOf[slot.entity.index] = kNone;
}

// Replaces deferred entities inside a value by the real ones, where it lies.
void CommandPlayback::resolve(const Op& op)
{
    for (const uint32_t offset : componentInfo(op.op->component).entityFields) {
        Entity entity;
        std::memcpy(&entity, op.value + offset, sizeof(entity));
        entity = real(entity, op.buffer);
        std::memcpy(op.value + offset, &entity, sizeof(entity));
    }
}

void CommandPlayback::merge(Slot& slot)
{
    ComponentMask mask = slot.from != nullptr ? slot.from->mask() : ComponentMask{};
    for (uint32_t at = slot.first; at != kNone; at = m_ops[at].next) {
        Op& op = m_ops[at];
        const ComponentId id = op.op->component;
        switch (op.op->kind) {
        case Kind::create:
            break;
        case Kind::destroy:
            slot.destroyed = true;
            break;
        case Kind::set:
            if (!mask.test(id)) {
                op.op->kind = Kind::remove; // nothing to write; a second removal is harmless
                ++m_statistics.dropped;
                break;
            }
            resolve(op);
            break;
        case Kind::add:
            mask.set(id);
            resolve(op);
            if (id == m_parent)
                slot.parent = &op;
            break;
        case Kind::remove:
            mask.reset(id);
            if (id == m_parent) {
                slot.parent = nullptr;
                slot.parentRemoved = true;
            }
            break;
        }
    }
    if (m_lastTo == nullptr || !(m_lastTo->mask() == mask))
        m_lastTo = &m_world.archetypeOf(mask);
    slot.to = m_lastTo;
}

void CommandPlayback::move()
{
    std::vector<uint32_t> order;
    for (uint32_t i = 0; i < m_slots.size(); ++i)
        if (m_slots[i].from != m_slots[i].to)
            order.push_back(i);
    const auto key = [&](uint32_t i) {
        const Slot& slot = m_slots[i];
        return std::pair(slot.to->index(), slot.from != nullptr ? slot.from->index() : kNone);
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
    for (size_t first = 0, end = 0; first < order.size(); first = end) {
        while (end < order.size() && key(order[end]) == key(order[first]))
            ++end;
        moveRun(std::span(order).subspan(first, end - first));
    }
    m_statistics.moves = static_cast<uint32_t>(order.size());
}

void CommandPlayback::moveRun(std::span<const uint32_t> run)
{
    Archetype& to = *m_slots[run[0]].to;
    Archetype* from = m_slots[run[0]].from;
    m_entities.clear();
    m_rows.clear();
    for (const uint32_t i : run) {
        m_entities.push_back(m_slots[i].entity);
        m_rows.emplace_back(from != nullptr ? m_world.m_entities[m_slots[i].entity].row : 0, i);
    }
    const uint32_t firstRow = to.append(m_entities, m_world.m_stamp);
    for (uint32_t k = 0; k < run.size(); ++k) {
        EntityRecord& record = m_world.m_entities[m_entities[k]];
        record.archetype = to.index();
        record.row = firstRow + k;
    }
    if (from == nullptr)
        return;
    to.copyRows(firstRow, *from, m_rows);
    // From the last row down: the row that fills a gap is then never one that leaves as well.
    std::sort(m_rows.begin(), m_rows.end(), std::greater<>());
    for (const auto& [row, slot] : m_rows)
        m_world.takeRowOut(*from, row);
}

void CommandPlayback::write(Slot& slot)
{
    const EntityRecord record = m_world.m_entities[slot.entity];
    for (uint32_t at = slot.first; at != kNone; at = m_ops[at].next) {
        const Op& op = m_ops[at];
        const bool writes = op.op->kind == Kind::add || op.op->kind == Kind::set;
        const int32_t column = slot.to->columnOf(op.op->component);
        if (!writes || column < 0)
            continue;
        slot.to->markRow(column, record.row, m_world.m_stamp);
        slot.to->write(op.op->component, record.row, op.value);
    }
}

void CommandPlayback::attach(const Slot& slot)
{
    if (slot.parentRemoved)
        m_world.m_hierarchy.detach(slot.entity);
    if (slot.parent == nullptr)
        return;
    Parent parent;
    std::memcpy(&parent, slot.parent->value, sizeof(parent));
    if (!m_world.alive(parent.entity)) {
        m_world.m_hierarchy.detach(slot.entity);
        m_orphans.push_back(slot.entity);
        return;
    }
    if (m_world.m_hierarchy.attach(slot.entity, parent.entity))
        return;
    ++m_statistics.refused;
    const Entity old = m_world.m_hierarchy.parentOf(slot.entity);
    if (old.isNull()) {
        m_world.remove<Parent>(slot.entity);
        return;
    }
    const World::Place at = m_world.place(slot.entity);
    at.archetype->write(m_parent, at.row, &old);
}

PlaybackStatistics play(World& world, std::span<CommandBuffer* const> buffers)
{
    return CommandPlayback(world, buffers).run();
}

PlaybackStatistics play(World& world, CommandBuffer& buffer)
{
    CommandBuffer* const one = &buffer;
    return play(world, {&one, 1});
}

} // namespace penumbra::ecs
