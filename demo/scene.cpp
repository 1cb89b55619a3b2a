#include "demo/scene.h"

#include "demo/scenes/falling.h"
#include "demo/scenes/lights.h"
#include "demo/scenes/materials.h"
#include "runtime/file.h"

#include <algorithm>
#include <fmt/ranges.h>

namespace penumbra {

std::span<const SceneEntry> sceneEntries()
{
    static constexpr SceneEntry kScenes[] = {
        {"falling", "20 objects of 8 shapes fall on a floor, collide and come to rest",
         loadFallingScene},
        {"lights", "two coloured spheres and a picture that shines move among objects",
         loadLightsScene},
        {"materials", "glossy balls whose exponents change, a texture and vertex colours",
         loadMaterialsScene},
    };
    return kScenes;
}

Result<std::unique_ptr<DemoScene>> loadScene(const std::string& name, const SceneOptions& options)
{
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
    return Error{
        fmt::format("no scene is called '{}'; there are: {}", name, fmt::join(names, ", "))};
}

Result<std::unique_ptr<DemoScene>> makeFloorScene(const SceneOptions& options, std::string name,
                                                  const std::string& environment)
{
    auto scene = std::make_unique<DemoScene>();
    scene->name = std::move(name);
    scene->ground = true;
    Result<Environment> sky = loadEnvironment(
        options.assets, options.environment.empty() ? environment : options.environment);
    if (!sky)
        return sky.error();
    scene->environment = std::move(*sky);
    Result<AssetHandle> floor = scene->assets.loadMesh(options.assets / "floor.glb");
    if (!floor)
        return floor.error();
    scene->world.create(Transform{}, MeshInstance{*floor},
                        Material{.albedo = vec3(0.62f, 0.60f, 0.57f)});
    return scene;
}

Result<Environment> loadEnvironment(const std::filesystem::path& assets, const std::string& name)
{
    const std::filesystem::path path = assets / (name + ".env");
    std::error_code ec;
    if (!std::filesystem::exists(path, ec)) {
        std::vector<std::string> names;
        const std::filesystem::directory_iterator end;
        for (std::filesystem::directory_iterator entry(assets, ec); entry != end;
             entry.increment(ec))
            if (entry->path().extension() == ".env")
                names.push_back(entry->path().stem().string());
        std::sort(names.begin(), names.end());
        return Error{fmt::format("no environment is called '{}'; {} has: {}", name, assets.string(),
                                 fmt::join(names, ", "))};
    }
    constexpr std::uint64_t kMaxBytes = 16u << 20; // a .env of the largest map takes 1 MiB
    Result<std::vector<std::byte>> bytes = readFile(path, kMaxBytes);
    if (!bytes)
        return bytes.error();
    Result<Environment> environment = decodeEnvironment(*bytes);
    if (!environment)
        return fail(environment.error(), path.string());
    return environment;
}

} // namespace penumbra
