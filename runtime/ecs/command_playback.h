// Private to command playback. In order:
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
#pragma once

#include "runtime/ecs/command_buffer.h"
#include "runtime/ecs/observer_table.h"

namespace penumbra::ecs {

class CommandPlayback {
public:
    CommandPlayback(World& world, std::span<CommandBuffer* const> buffers)
        : m_world(world), m_buffers(buffers), m_parent(componentId<Parent>())
    {}

    PlaybackStatistics run();

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

} // namespace penumbra::ecs
