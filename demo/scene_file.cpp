#include "demo/scene_file.h"

#include "demo/gloss_cycle.h"
#include "demo/orbit.h"
#include "demo/sky_motion.h"
#include "runtime/file.h"
#include "shaders/shared/instance.h"
#include "systems/physics_system.h"
#include "systems/scene_components.h"
#include "systems/transforms.h"

#include <algorithm>
#include <limits>

namespace penumbra {

namespace {

constexpr const char* kDefaultSky = "courtyard";

bool isEnvironment(const ecs::Field& field)
{
    return field.kind == "environment";
}

const char* extensionOf(const ecs::Field& field)
{
    return isEnvironment(field) ? ".env" : ".glb";
}

void registerAll()
{
    registerSceneComponents();
    ecs::registerComponents<Orbit, GlossCycle, SkyMotion, SkyFade>();
}

// Sees all meshes from obliquely above.
Camera cameraOfAll(ecs::World& world, const AssetStore& assets)
{
    vec3 low(std::numeric_limits<float>::infinity()), high(-low);
    addWorldTransforms(world);
    world.query<const Transform, const MeshInstance>().each(
        [&](ecs::Entity entity, const Transform&, const MeshInstance& instance) {
            if (!assets.hasMesh(instance.asset))
                return;
            const Transform& at = worldTransform(world, entity);
            const MeshAsset& mesh = assets.mesh(instance.asset);
            for (int corner = 0; corner < 8; ++corner) {
                const vec3 p(corner & 1 ? mesh.boundsMax.x : mesh.boundsMin.x,
                             corner & 2 ? mesh.boundsMax.y : mesh.boundsMin.y,
                             corner & 4 ? mesh.boundsMax.z : mesh.boundsMin.z);
                const vec3 q = at.position + rotate(at.rotation, at.scale * p);
                low = glm::min(low, q);
                high = glm::max(high, q);
            }
        });
    Camera camera;
    if (low.x > high.x)
        return camera;
    const float radius = std::max(0.5f * glm::length(high - low), 1e-3f);
    camera.target = 0.5f * (low + high);
    camera.distance = 1.1f * radius / std::sin(camera.fieldOfView / 2);
    camera.near = 0.01f * radius;
    camera.far = 100 * radius;
    return camera;
}

// The file's sky, that of the options in its place, or one for a file in which nothing shines.
Result<void> chooseSky(DemoScene& scene, const SceneOptions& options)
{
    std::vector<ecs::Entity> skies;
    scene.world.query<ecs::With<EnvironmentLight>>().each(
        [&](ecs::Entity entity) { skies.push_back(entity); });
    const bool dark =
        skies.empty() && scene.world.query<ecs::With<ShadowFieldEmitter>>().count() == 0;
    if (options.environment.empty() && !dark)
        return {};
    const std::string name = options.environment.empty() ? kDefaultSky : options.environment;
    const Result<AssetHandle> map = loadEnvironment(scene, options.assets, name);
    if (!map)
        return map.error();
    if (options.environment.empty())
        scene.warnings.push_back(fmt::format(
            "nothing in it shines: lit by '{}'; choose another sky with --environment", name));
    if (skies.empty())
        scene.world.create(ecs::Name(name), EnvironmentLight{.asset = *map});
    else
        scene.world.get<EnvironmentLight>(skies.front()).asset = *map;
    return {};
}

} // namespace

SceneAssetNames::SceneAssetNames(AssetStore& store, std::filesystem::path beside,
                                 std::filesystem::path assets)
    : m_store(store), m_beside(std::move(beside)), m_assets(std::move(assets))
{}

Result<std::uint32_t> SceneAssetNames::handleOf(const ecs::Field& field, const std::string& name)
{
    const std::string extension = extensionOf(field);
    for (const std::filesystem::path& folder : {m_beside, m_assets})
        for (const std::string& file : {name + extension, name}) {
            const std::filesystem::path path = (folder / file).lexically_normal();
            std::error_code ec;
            if (!std::filesystem::is_regular_file(path, ec))
                continue;
            const Result<AssetHandle> handle =
                isEnvironment(field) ? m_store.loadEnvironment(path) : m_store.loadMesh(path);
            if (!handle)
                return handle.error();
            return handle->index;
        }
    return Error{fmt::format("'{}' ({}) is neither in {} nor in {}; compile it with assetc {}",
                             name, extension, m_beside.empty() ? "." : m_beside.string(),
                             m_assets.string(),
                             isEnvironment(field)    ? "environment"
                             : field.kind == "light" ? "light"
                                                     : "bake")};
}

std::string SceneAssetNames::nameOf(const ecs::Field& field, std::uint32_t handle) const
{
    const AssetHandle asset{handle};
    const bool known =
        isEnvironment(field) ? m_store.hasEnvironment(asset) : m_store.hasMesh(asset);
    if (!known)
        return {};
    const std::filesystem::path path =
        isEnvironment(field) ? m_store.environmentPath(asset) : m_store.path(asset);
    std::error_code ec;
    const bool hidden = std::filesystem::exists(m_beside / path.filename(), ec);
    if (std::filesystem::equivalent(path.parent_path(), m_assets, ec) && !hidden &&
        path.extension() == extensionOf(field))
        return path.stem().string();
    const std::filesystem::path relative = std::filesystem::proximate(
        path, m_beside.empty() ? std::filesystem::path(".") : m_beside, ec);
    return (ec ? path : relative).string();
}

Result<std::unique_ptr<DemoScene>> loadSceneFile(const std::filesystem::path& path,
                                                 const SceneOptions& options)
{
    const Result<std::vector<std::byte>> bytes = readFile(path, ecs::kMaxSceneBytes);
    if (!bytes)
        return bytes.error();
    registerAll();
    auto scene = std::make_unique<DemoScene>();
    scene->name = path.stem().string();
    scene->path = path;
    SceneAssetNames names(scene->assets, path.parent_path(), options.assets);
    const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    Result<ecs::LoadedScene> loaded = ecs::loadScene(scene->world, scene->file, text, &names);
    if (!loaded)
        return fail(loaded.error(), path.string());
    for (const std::string& warning : loaded->warnings)
        scene->warnings.push_back(fmt::format("{}: {}", path.string(), warning));
    if (Result<void> lit = chooseSky(*scene, options); !lit)
        return lit.error();
    bool placed = false;
    scene->world.query<const Camera>().each([&](const Camera& camera) {
        if (!placed)
            scene->camera = camera;
        placed = true;
    });
    if (scene->camera.near >= scene->camera.far)
        return Error{fmt::format("{}: its Camera's near, {} m, is not before far, {} m",
                                 path.string(), scene->camera.near, scene->camera.far)};
    if (!placed)
        scene->camera = cameraOfAll(scene->world, scene->assets);
    return scene;
}

Result<std::vector<std::string>> saveSceneFile(DemoScene& scene, const Camera& camera,
                                               const std::filesystem::path& path,
                                               const std::filesystem::path& assets)
{
    registerAll();
    ecs::Entity eye;
    scene.world.query<ecs::With<Camera>>().each([&](ecs::Entity entity) {
        if (eye.isNull())
            eye = entity;
    });
    if (eye.isNull())
        scene.world.create(ecs::Name("camera"), camera);
    else
        scene.world.set(eye, camera);
    if (scene.physics)
        scene.world.query<RigidBody, const PhysicsBody>().each(
            [&](RigidBody& body, const PhysicsBody& moved) {
                const Motion motion = scene.physics->motion(moved.id);
                body.velocity = motion.velocity;
                body.angularVelocity = motion.angularVelocity;
            });
    const SceneAssetNames names(scene.assets, path.parent_path(), assets);
    const Result<ecs::SavedScene> saved = ecs::saveScene(scene.world, scene.file, &names);
    if (!saved)
        return fail(saved.error(), path.string());
    if (Result<void> written = writeFile(path, saved->text); !written)
        return written.error();
    return saved->warnings;
}

} // namespace penumbra
