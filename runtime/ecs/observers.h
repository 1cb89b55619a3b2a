// Observers: functions that a World calls when a component comes, is overwritten, or goes.
//
//   const Observer watch = onAdd<Health>(world, [&](const Observation& seen) {
//       for (const Entity entity : seen.entities)
//           if (seen.world.get<const Health>(entity).points == 0)
//               seen.commands.add(entity, Dying{});
//   }); // until `watch` goes
//
// What is told:
//   onAdd     the component came, with its value: create, add, a command buffer's merged commands,
//             prefabs, scene files
//   onSet     a value was given over an old one: World::set, add, setParent, setSingleton, the same
//             commands, and writeComponent(). Not writes through references, queries or
//             SystemContext: they may be on any thread; Changed<> finds those.
//   onRemove  the component is about to go, its value still there: remove, destroy (`ending`), with
//             everything below. Not the end of the World itself, nor restoreSnapshot().
// A command buffer tells what differs between before and after: first what goes, before anything
// moves; once all is moved, written and attached, what came, then what was set; then its destroys.
//
// Order: by entity, in the order of the operation's list or of each entity's first command, parents
// before what is below them; neighbours with the same components come in one call. One call after
// the other goes to each observer, in the order in which they were made. The same at any number of
// threads.
//
// The world is const meanwhile. An observer's own changes go to `commands`; they are made when the
// operation that caused them is complete, and told in turn, until no more come. References that
// the operation returned are then stale, and an entity that it created may be gone.
//
// Without observers, operations pay one branch; with observers of other components, a mask test.
#pragma once

#include "runtime/ecs/command_buffer.h"
#include "runtime/ecs/world.h"

#include <functional>
#include <memory>

namespace penumbra::ecs {

enum class ObservedEvent : uint8_t { add, set, remove };

struct Observation {
    const World& world;
    CommandBuffer& commands;
    std::span<const Entity> entities; // alive, all with the same components
    ComponentId component;
    ObservedEvent event;
    bool ending; // the entities are being destroyed
};

using ObserverFunction = std::function<void(const Observation&)>;

// Ends the observer when it goes; may outlive the World, and may go within a call.
class [[nodiscard]] Observer {
public:
    struct State {
        ObserverFunction function;
        ComponentId component;
        ObservedEvent event;
        bool ended = false;
    };

    Observer() = default;
    explicit Observer(std::shared_ptr<State> state) : m_state(std::move(state)) {}
    Observer(Observer&&) noexcept = default;
    Observer& operator=(Observer&& other) noexcept
    {
        std::swap(m_state, other.m_state);
        return *this;
    }
    ~Observer()
    {
        if (m_state != nullptr)
            m_state->ended = true; // World lets it go at the next operation that looks
    }

private:
    std::shared_ptr<State> m_state;
};

Observer observe(World& world, ObservedEvent event, ComponentId component,
                 ObserverFunction function);

template <class T>
Observer onAdd(World& world, ObserverFunction function)
{
    return observe(world, ObservedEvent::add, componentId<T>(), std::move(function));
}
template <class T>
Observer onSet(World& world, ObserverFunction function)
{
    static_assert(!kIsTag<T>, "a tag has no value: onAdd");
    return observe(world, ObservedEvent::set, componentId<T>(), std::move(function));
}
template <class T>
Observer onRemove(World& world, ObserverFunction function)
{
    return observe(world, ObservedEvent::remove, componentId<T>(), std::move(function));
}

} // namespace penumbra::ecs
