// Playback of command buffers, in order:
//   collect    ops -> one slot per entity; new entities get their ids, in recording order
//   merge      a slot's ops -> its final set of components; deferred entities in values -> real
//   tell       observers, of what goes
//   move       slots that go from one archetype to one other form a run, which moves column by
//              column; runs go by (destination, source)
//   write      values, in recording order
//   attach     parents
//   enable     and disable
//   tell       what came, then what was set
//   destroy    which tells by itself
#include "runtime/ecs/command_buffer.h"

#include "runtime/assert.h"
#include "runtime/ecs/observer_table.h"

#include <algorithm>

namespace penumbra::ecs {

class CommandPlayback {
public:
    CommandPlayback(World& world, std::span<CommandBuffer* const> buffers)
        : m_world(world), m_buffers(buffers), m_parent(componentId<Parent>())
    {}

    PlaybackStatistics run()
    {
        m_world.assertStructural();
        ObserverTable* const observers = m_world.m_observers;
        if (observers != nullptr)
            observers->enter();
        collect();
        for (uint32_t i = 0; i < m_slots.size(); ++i)
            merge(i);
        if (observers != nullptr)
            tell(*observers, ObservedEvent::remove);
        move();
        for (const Slot& slot : m_slots)
            write(slot);
        for (Slot& slot : m_slots)
            attach(slot);
        if (m_enables)
            setEnabled();
        if (observers != nullptr) {
            tell(*observers, ObservedEvent::add);
            tell(*observers, ObservedEvent::set);
        }
        std::vector<Entity> doomed;
        for (const Slot& slot : m_slots)
            if (slot.destroyed)
                doomed.push_back(slot.entity);
        m_world.destroyMany(doomed);
        for (CommandBuffer* buffer : m_buffers)
            buffer->clear();
        if (observers != nullptr)
            observers->leave();
        return m_statistics;
    }

private:
    using Op = CommandBuffer::Op;
    using Kind = CommandBuffer::Kind;

    struct Slot {
        Entity entity;
        Op* first = nullptr;
        Op* last = nullptr;
        Archetype* from = nullptr; // null: new
        Archetype* to = nullptr;
        bool destroyed = false;
        bool parentRemoved = false;
        const Op* parent = nullptr; // the op that gave its last Parent value
    };
    struct Run {
        Archetype* from;
        Archetype* to;
        std::vector<Entity> entities;
    };

    void collect();
    void merge(uint32_t slotIndex);
    void resolve(const Op& op);
    void move();
    void moveRun(const Run& run);
    void write(const Slot& slot);
    void attach(Slot& slot);
    void setEnabled();
    void tell(ObserverTable& observers, ObservedEvent event);
    [[nodiscard]] ComponentMask whatHappened(const Slot& slot, ObservedEvent event) const;
    [[nodiscard]] Entity real(Entity entity, uint32_t buffer) const;
    [[nodiscard]] std::byte* valueOf(const Op& op) const
    {
        return m_buffers[op.buffer]->valueAt(op.component, op.value);
    }
    [[nodiscard]] Run& runOf(Archetype* from, Archetype* to);

    World& m_world;
    std::span<CommandBuffer* const> m_buffers;
    ComponentId m_parent;
    std::vector<Slot> m_slots;
    std::vector<std::vector<Entity>> m_created; // [buffer][deferred index]
    std::vector<Run> m_runs;
    uint32_t m_lastRun = 0;        // most entities go the way of the one before
    Archetype* m_lastTo = nullptr; // likewise
    bool m_enables = false;        // there are such commands
    PlaybackStatistics m_statistics;
};

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

void CommandPlayback::move()
{
    m_world.m_hierarchy.makeRoom(m_world.m_entities.indexCount());
    const auto key = [](const Run& run) {
        return std::pair(run.to->index(), run.from != nullptr ? run.from->index() : kNone);
    };
    std::sort(m_runs.begin(), m_runs.end(),
              [&](const Run& a, const Run& b) { return key(a) < key(b); });
    for (const Run& run : m_runs)
        moveRun(run);
}

void CommandPlayback::moveRun(const Run& run)
{
    m_statistics.moves += static_cast<uint32_t>(run.entities.size());
    if (run.from != nullptr) {
        static_cast<void>(m_world.moveRun(run.entities, *run.from, *run.to));
        return;
    }
    m_world.makeRoom(*run.to, static_cast<uint32_t>(run.entities.size()));
    m_world.setPlaces(*run.to, run.to->append(run.entities, m_world.m_stamp));
}

void CommandPlayback::write(const Slot& slot)
{
    if (slot.destroyed)
        return;
    const uint32_t row = m_world.m_entities.place(slot.entity).row;
    ComponentMask there = slot.from != nullptr ? slot.from->mask() : ComponentMask{};
    for (const Op* op = slot.first; op != nullptr; op = op->next) {
        const bool writes = op->kind == Kind::add || op->kind == Kind::set;
        const int32_t column = slot.to->columnOf(op->component);
        if (!writes || column < 0)
            continue;
        if (slot.from == slot.to) // else the new row is marked already
            slot.to->markRow(static_cast<uint32_t>(column), row, m_world.m_stamp);
        if (componentInfo(op->component).life == nullptr)
            slot.to->write(op->component, row, valueOf(*op));
        else
            slot.to->moveIn(op->component, row, valueOf(*op), there.test(op->component));
        there.set(op->component);
    }
}

void CommandPlayback::attach(Slot& slot)
{
    Hierarchy& hierarchy = m_world.m_hierarchy;
    if (slot.parentRemoved)
        hierarchy.detach(slot.entity);
    if (slot.parent == nullptr)
        return;
    Parent parent;
    std::memcpy(&parent, valueOf(*slot.parent), sizeof(parent));
    if (!m_world.alive(parent.entity)) {
        hierarchy.detach(slot.entity);
        slot.destroyed = true;
        return;
    }
    if (hierarchy.attach(slot.entity, parent.entity))
        return;
    ++m_statistics.refused;
    const Entity old = hierarchy.parentOf(slot.entity);
    if (old.isNull() && slot.from != nullptr && slot.from->mask().test(m_parent))
        return m_world.remove<Parent>(slot.entity);
    if (old.isNull()) { // observers were not told that it has one
        ComponentMask mask = m_world.components(slot.entity);
        if (mask.test(m_parent)) {
            mask.reset(m_parent);
            m_world.move(slot.entity, m_world.place(slot.entity), m_world.archetypeOf(mask));
        }
        return;
    }
    const Place at = m_world.place(slot.entity);
    at.archetype->write(m_parent, at.row, &old);
}

void CommandPlayback::setEnabled()
{
    for (uint32_t b = 0; b < m_buffers.size(); ++b)
        for (const Op& op : m_buffers[b]->m_ops) {
            const bool enable = op.kind == Kind::enable;
            if (!enable && op.kind != Kind::disable)
                continue;
            const Entity entity = real(op.target, b);
            if (m_world.alive(entity)) // else counted as dropped already
                m_world.setEnabled(entity, enable, static_cast<Reach>(op.value));
        }
}

ComponentMask CommandPlayback::whatHappened(const Slot& slot, ObservedEvent event) const
{
    const ComponentMask before = slot.from != nullptr ? slot.from->mask() : ComponentMask{};
    if (event == ObservedEvent::remove)
        return before - slot.to->mask();
    const ComponentMask& now = m_world.place(slot.entity).archetype->mask();
    if (event == ObservedEvent::add)
        return now - before;
    ComponentMask written;
    for (const Op* op = slot.destroyed ? nullptr : slot.first; op != nullptr; op = op->next)
        if ((op->kind == Kind::add || op->kind == Kind::set) && now.test(op->component) &&
            before.test(op->component))
            written.set(op->component);
    return written;
}

void CommandPlayback::tell(ObserverTable& observers, ObservedEvent event)
{
    ObserverRun run(observers, event);
    for (const Slot& slot : m_slots)
        if (event != ObservedEvent::remove || slot.from != nullptr)
            run.add(slot.entity, m_world.components(slot.entity), whatHappened(slot, event));
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
