// Command playback: the steps, and what they do to the world.
#include "runtime/ecs/command_playback.h"

#include <algorithm>

namespace penumbra::ecs {

PlaybackStatistics CommandPlayback::run()
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
