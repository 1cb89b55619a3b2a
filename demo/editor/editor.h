// The editor panel: all entities of a world, and the components of the selected one as their
// descriptions say (runtime/ecs/field.h). It knows no component.
#pragma once

#include "assets/asset_store.h"
#include "runtime/ecs/world.h"

#include <string>

namespace penumbra {

class Editor {
public:
    // Inside an ImGui frame, between two runs of the schedule. Writes what the user edits, marked
    // as changed.
    void draw(ecs::World& world, const AssetStore& assets);

    void select(ecs::Entity entity) { m_selected = entity; }
    [[nodiscard]] ecs::Entity selected() const { return m_selected; }

private:
    void drawList(ecs::World& world, const AssetStore& assets);
    void drawComponents(ecs::World& world, const AssetStore& assets) const;

    ecs::Entity m_selected{}; // null: none
    char m_filter[64] = {};   // part of what the list shows; empty: all
};

} // namespace penumbra
