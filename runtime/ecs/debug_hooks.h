// DebugHooks: what other parts teach the ECS for its messages and World::dump(). Process-wide; set
// at start-up, before worlds are in use.
#pragma once

#include "runtime/ecs/component.h"
#include "runtime/ecs/entity_table.h"

namespace penumbra::ecs {

struct DebugHooks {
    // The component that holds an entity's name, and how to read it; see nameEntitiesBy(). Null:
    // Name (name.h).
    uint32_t nameComponent = kNone;
    std::string (*name)(const void* value) = nullptr;
    // A value on one line, field by field; at first fieldsText() (reflection.h). Empty text, or
    // null: World::dump() shows words.
    std::string (*value)(ComponentId component, const void* value) = nullptr;
};

[[nodiscard]] DebugHooks& debugHooks();

// text(value) -> std::string_view or std::string; a captureless lambda. T is not split into lanes.
template <class T, class Text>
void nameEntitiesBy(Text)
{
    static_assert(std::is_empty_v<Text> && kLaneCount<T> == 1);
    debugHooks().nameComponent = componentId<T>();
    debugHooks().name = [](const void* value) {
        return std::string(Text{}(*static_cast<const T*>(value)));
    };
}

} // namespace penumbra::ecs
