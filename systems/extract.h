// From entities to the renderer's instances and lights: once when a scene starts, then only what
// changed.
#pragma once

#include "runtime/ecs/system_context.h"
#include "runtime/ecs/world.h"
#include "systems/components.h"
#include "systems/gpu_scene.h"
#include "systems/scene_data.h"

namespace penumbra {

// Which instance of SceneData the entity is.  Written by: extractScene.  Read by: gatherChanged.
struct RenderInstance {
    static constexpr std::string_view kName = "RenderInstance";
    static constexpr bool kTransient = true;
    std::uint32_t index = 0;
};

// Which light of SceneData the entity is.  Written by: extractScene.  Read by: gatherChanged.
struct RenderLight {
    static constexpr std::string_view kName = "RenderLight";
    static constexpr bool kTransient = true;
    std::uint32_t index = 0;
};

// Gives every entity with Transform and MeshInstance an instance, and every one with Transform and
// ShadowFieldEmitter a light, in the order of the queries, and packs the scene. Asset index = asset
// handle. Error: an emitter's or occluder's asset has no field of the kind, or an
// EnvironmentLight's is no environment of the store; the message names the entity.
Result<SceneData> extractScene(ecs::World& world, const AssetStore& assets);

// What changed since the systems' last run.
struct SceneChanges {
    struct Moved {
        std::uint32_t index = 0;
        Transform transform;
    };
    struct Repainted {
        std::uint32_t index = 0;
        Material material;
    };
    struct Dimmed {
        std::uint32_t index = 0;
        vec3 intensity{1};
    };
    std::vector<Moved> instances, lights;
    std::vector<Repainted> materials;
    std::vector<Dimmed> intensities;
    // All of them, in the order of the query; kept from run to run. `relit`: they changed.
    std::vector<EnvironmentLight> environments;
    bool relit = false;

    void clear();
};

// System: reads Transform, WorldTransform, Material, ShadowFieldEmitter, EnvironmentLight,
// RenderInstance, RenderLight. Appends to `out`.
void gatherChanged(const ecs::SystemContext& context, SceneChanges& out);

// All but the environments, which EnvironmentLighting takes.
void applyChanges(const SceneChanges& changes, GpuScene& scene);

} // namespace penumbra
