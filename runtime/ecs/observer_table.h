// Private to World and command playback: the observers of one world, and whom to call when.
#pragma once

#include "runtime/ecs/observers.h"

namespace penumbra::ecs {

class ObserverTable {
public:
    explicit ObserverTable(World& world) : m_world(world) {}
    [[nodiscard]] static ObserverTable& of(World& world); // made at the first call

    Observer add(ObservedEvent event, ComponentId component, ObserverFunction function);
    [[nodiscard]] bool observes(ObservedEvent event, const ComponentMask& mask) const
    {
        return m_masks[static_cast<size_t>(event)].intersects(mask);
    }
    // `what` happened, or is about to, to entities of one archetype.
    void tell(ObservedEvent event, const ComponentMask& what, std::span<const Entity> entities,
              bool ending = false);
    [[nodiscard]] bool telling() const { return m_telling; }

    // An operation made of others: observers' commands wait until the outermost one is left.
    void enter() { ++m_depth; }
    void leave();
    void abandon() { --m_depth; } // the commands wait for the next operation
    // After a single operation: plays what observers recorded, unless inside another.
    void settle();

private:
    // A chain of causes this long is a loop.
    static constexpr uint32_t kMaxRounds = 64;

    void dropEnded();

    World& m_world;
    std::vector<std::shared_ptr<Observer::State>> m_observers; // in the order they were made
    std::array<ComponentMask, 3> m_masks;                      // [event]
    CommandBuffer m_commands{0xfff};
    CommandBuffer m_playing{0xffe};
    uint32_t m_depth = 0;
    bool m_telling = false;
    bool m_settling = false;
};

// Joins neighbours of one archetype, to which the same happens, into one call.
class ObserverRun {
public:
    ObserverRun(ObserverTable& table, ObservedEvent event, bool ending = false)
        : m_table(table), m_event(event), m_ending(ending)
    {}
    ~ObserverRun() { flush(); }
    ObserverRun(const ObserverRun&) = delete;
    ObserverRun& operator=(const ObserverRun&) = delete;

    void add(Entity entity, const ComponentMask& components, const ComponentMask& what)
    {
        if (!(what == m_what) || !(components == m_components))
            flush();
        m_what = what;
        m_components = components;
        if (m_table.observes(m_event, what))
            m_entities.push_back(entity);
    }

private:
    void flush()
    {
        if (!m_entities.empty())
            m_table.tell(m_event, m_what, m_entities, m_ending);
        m_entities.clear();
    }

    ObserverTable& m_table;
    ObservedEvent m_event;
    bool m_ending;
    ComponentMask m_components, m_what;
    std::vector<Entity> m_entities;
};

} // namespace penumbra::ecs
