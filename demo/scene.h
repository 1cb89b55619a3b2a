// A scene of the demo: a world with its bodies, assets, light and camera.
#pragma once

#include "assets/asset_store.h"
#include "demo/options.h"
#include "runtime/ecs/scene_file.h"
#include "runtime/ecs/world.h"
#include "systems/components.h"
#include "systems/physics/physics_world.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace penumbra {

struct DemoScene {
    std::string name;
    AssetStore assets;
    ecs::World world;
    std::filesystem::path path;          // of its file; empty: made by code
    ecs::Scene file;                     // what the file says beyond the world
    std::optional<PhysicsWorld> physics; // loadScene; nothing: no entity has a RigidBody
    Camera camera;
    std::vector<std::string> warnings; // of its file

    [[nodiscard]] bool ground() const { return world.query<ecs::With<Ground>>().count() > 0; }
};

struct SceneOptions {
    std::filesystem::path assets; // folder of compiled assets
    std::uint64_t seed = 1;
    std::string
        environment; // name of a .env in `assets`, for the first of the scene; empty: its own
    std::string floor = "floor"; // name of a .glb in `assets`
};

struct SceneEntry {
    std::string_view name, description;
    Result<std::unique_ptr<DemoScene>> (*load)(const SceneOptions& options);
};
std::span<const SceneEntry> sceneEntries();

// `name` of a scene, or a scene file (.json). Error: no such scene, the message lists all; or an
// asset that is missing or damaged.
Result<std::unique_ptr<DemoScene>> loadScene(const std::string& name, const SceneOptions& options);

// loadScene, with the scene's warnings on stderr.
Result<std::unique_ptr<DemoScene>> openScene(const DemoOptions& options);

// A scene on the floor, which lies in the light: the sky that the options ask for, else
// `environment`, and `floor`. Error: one of them is missing or damaged.
Result<std::unique_ptr<DemoScene>> makeFloorScene(const SceneOptions& options, std::string name,
                                                  const std::string& environment,
                                                  float intensity = 1);

// The map `name` of the folder `assets`, without .env. Error: no such map, the message lists all;
// or a damaged one.
Result<AssetHandle> loadEnvironment(DemoScene& scene, const std::filesystem::path& assets,
                                    const std::string& name);

// An entity with an EnvironmentLight of that map, and its name.
Result<ecs::Entity> addEnvironment(DemoScene& scene, const std::filesystem::path& assets,
                                   const std::string& name, float intensity = 1);

// All that addEnvironment knows, sorted.
std::vector<std::string> environmentNames(const std::filesystem::path& assets);

} // namespace penumbra
