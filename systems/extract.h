// From entities to the renderer's instances: once when a scene starts, then only what changed.
#pragma once

#include "runtime/ecs/system_context.h"
#include "runtime/ecs/world.h"
#include "systems/components.h"
#include "systems/scene_data.h"

namespace penumbra {

// Which instance of SceneData the entity is.  Written by: extractScene.  Read by: gatherChanged.
struct RenderInstance {
    static constexpr std::string_view kName = "RenderInstance";
    std::uint32_t index = 0;
};

// Gives every entity with Transform and MeshInstance an instance, in the order of the query, and
// packs the scene. Mesh index = asset handle. The entity blocks light if it has a
// ShadowFieldOccluder.
SceneData extractScene(ecs::World& world, const AssetStore& assets);

// An instance that moved since the system's last run.
struct ChangedInstance {
    std::uint32_t index = 0;
    Transform transform;
};

// System: reads Transform, RenderInstance. Appends to `out`.
void gatherChanged(const ecs::SystemContext& context, std::vector<ChangedInstance>& out);

} // namespace penumbra
