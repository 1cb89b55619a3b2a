#include "runtime/ecs/observer_table.h"

#include "runtime/assert.h"

namespace penumbra::ecs {

Observer ObserverTable::add(ObservedEvent event, ComponentId component, ObserverFunction function)
{
    m_masks[static_cast<size_t>(event)].set(component);
    const auto state =
        std::make_shared<Observer::State>(Observer::State{std::move(function), component, event});
    m_observers.push_back(state);
    return Observer(state);
}

void ObserverTable::tell(ObservedEvent event, const ComponentMask& what,
                         std::span<const Entity> entities, bool ending)
{
    PENUMBRA_ASSERT(!m_telling, "structural change in an observer: use its commands");
    if (entities.empty() || !observes(event, what))
        return;
    dropEnded();
    m_telling = true;
    const size_t count = m_observers.size(); // those made meanwhile begin with the next call
    for (size_t i = 0; i < count; ++i) {
        const std::shared_ptr<Observer::State> observer = m_observers[i]; // may end itself
        if (!observer->ended && observer->event == event && what.test(observer->component))
            observer->function({m_world, m_commands, entities, observer->component, event, ending});
    }
    m_telling = false;
}

void ObserverTable::dropEnded()
{
    if (std::erase_if(m_observers, [](const auto& observer) { return observer->ended; }) == 0)
        return;
    m_masks = {};
    for (const auto& observer : m_observers)
        m_masks[static_cast<size_t>(observer->event)].set(observer->component);
}

void ObserverTable::leave()
{
    --m_depth;
    settle();
}

void ObserverTable::settle()
{
    if (m_depth > 0 || m_settling)
        return;
    m_settling = true;
    for (uint32_t round = 0; !m_commands.isEmpty(); ++round) {
        PENUMBRA_ASSERT(round < kMaxRounds, "observers still cause changes after {} rounds",
                        kMaxRounds);
        std::swap(m_commands, m_playing); // what this round causes is recorded for the next
        play(m_world, m_playing);
    }
    m_settling = false;
}

} // namespace penumbra::ecs
