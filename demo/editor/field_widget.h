// One widget per described member of a component (runtime/ecs/field.h): what an editor draws
// without knowing the component.
#pragma once

#include "runtime/ecs/field.h"
#include "runtime/ecs/world.h"

#include <functional>
#include <string>

namespace penumbra {

// What a widget shows for things that are numbers in memory.
struct FieldNames {
    const ecs::World& world;                                            // of entities
    std::function<std::string(const ecs::Field&, std::uint32_t)> asset; // of handles; may be null
};

// Inside an ImGui frame. Shows `member` (field.bytes bytes) with its name, unit and range, and
// edits it in place. True: the value changed, and still is one that files may hold (fieldProblem).
// Assets, entities and whatever else has a `kind` are shown, not edited.
bool fieldWidget(const ecs::Field& field, std::byte* member, const FieldNames& names);

} // namespace penumbra
