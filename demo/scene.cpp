#include "demo/scene.h"

#include "demo/scene_file.h"
#include "demo/scenes/falling.h"
#include "demo/scenes/lights.h"
#include "demo/scenes/materials.h"
#include "demo/scenes/sky.h"
#include "runtime/ecs/name.h"
#include "systems/physics_system.h"

#include <algorithm>
#include <fmt/ranges.h>

namespace penumbra {

std::span<const SceneEntry> sceneEntries()
{
    static constexpr SceneEntry kScenes[] = {
        {"coarse", "scene falling on a floor of two triangles: see it with --receivers pixel",
         loadCoarseScene},
        {"falling", "20 objects of 8 shapes fall on a floor, collide and come to rest",
         loadFallingScene},
        {"lights", "two coloured spheres and a picture that shines move among objects",
         loadLightsScene},
        {"materials", "glossy balls whose exponents change, a texture and vertex colours",
         loadMaterialsScene},
        {"sky", "the sky over objects at rest turns once and fades to another and back, in 8 s",
         loadSkyScene},
    };
    return kScenes;
}

namespace {

// Without its physics.
Result<std::unique_ptr<DemoScene>> load(const std::string& name, const SceneOptions& options)
{
    if (name.ends_with(".json"))
        return loadSceneFile(name, options);
    std::error_code ec;
    if (!std::filesystem::is_directory(options.assets, ec))
        return Error{fmt::format("no folder of compiled assets at {}; build the project, or name "
                                 "the folder with --assets",
                                 options.assets.string())};
    std::vector<std::string_view> names;
    for (const SceneEntry& entry : sceneEntries()) {
        if (entry.name == name)
            return entry.load(options);
        names.push_back(entry.name);
    }
    return Error{fmt::format("no scene is called '{}'; there are: {}, and scene files (.json)",
                             name, fmt::join(names, ", "))};
}

} // namespace

Result<std::unique_ptr<DemoScene>> loadScene(const std::string& name, const SceneOptions& options)
{
    Result<std::unique_ptr<DemoScene>> scene = load(name, options);
    if (!scene)
        return scene;
    Result<std::optional<PhysicsWorld>> physics = buildPhysics((*scene)->world, (*scene)->assets);
    if (!physics)
        return fail(physics.error(), name);
    (*scene)->physics = std::move(*physics);
    return scene;
}

Result<std::unique_ptr<DemoScene>> openScene(const DemoOptions& options)
{
    Result<std::unique_ptr<DemoScene>> scene =
        loadScene(options.scene, {options.assets, options.seed, options.environment});
    if (scene)
        for (const std::string& warning : (*scene)->warnings)
            fmt::print(stderr, "penumbra-demo: {}\n", warning);
    return scene;
}

Result<std::unique_ptr<DemoScene>> makeFloorScene(const SceneOptions& options, std::string name,
                                                  const std::string& environment, float intensity)
{
    auto scene = std::make_unique<DemoScene>();
    scene->name = std::move(name);
    if (Result<ecs::Entity> sky = addEnvironment(
            *scene, options.assets, options.environment.empty() ? environment : options.environment,
            intensity);
        !sky)
        return sky.error();
    Result<AssetHandle> floor = scene->assets.loadMesh(options.assets / (options.floor + ".glb"));
    if (!floor)
        return floor.error();
    scene->world.create(Ground{}, Transform{}, MeshInstance{*floor},
                        Material{.albedo = vec3(0.62f, 0.60f, 0.57f)});
    return scene;
}

std::vector<std::string> environmentNames(const std::filesystem::path& assets)
{
    std::vector<std::string> names;
    std::error_code ec;
    const std::filesystem::directory_iterator end;
    for (std::filesystem::directory_iterator entry(assets, ec); entry != end; entry.increment(ec))
        if (entry->path().extension() == ".env")
            names.push_back(entry->path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

Result<AssetHandle> loadEnvironment(DemoScene& scene, const std::filesystem::path& assets,
                                    const std::string& name)
{
    const std::filesystem::path path = assets / (name + ".env");
    std::error_code ec;
    if (!std::filesystem::exists(path, ec))
        return Error{fmt::format("no environment is called '{}'; {} has: {}", name, assets.string(),
                                 fmt::join(environmentNames(assets), ", "))};
    return scene.assets.loadEnvironment(path);
}

Result<ecs::Entity> addEnvironment(DemoScene& scene, const std::filesystem::path& assets,
                                   const std::string& name, float intensity)
{
    const Result<AssetHandle> map = loadEnvironment(scene, assets, name);
    if (!map)
        return map.error();
    return scene.world.create(ecs::Name(name),
                              EnvironmentLight{.asset = *map, .intensity = intensity});
}

} // namespace penumbra
