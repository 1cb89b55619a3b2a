#include "systems/extract.h"

#include "systems/transforms.h"

namespace penumbra {

namespace {

constexpr float kMinScale = 1e-6f, kMaxScale = 1e6f; // in the world, as Transform's own

// Error: the entity's asset cannot be what `use` says.
Result<void> needField(const ecs::World& world, ecs::Entity entity, const AssetStore& assets,
                       AssetHandle asset, FieldKind kind, std::string_view use)
{
    if (!assets.hasMesh(asset))
        return Error{fmt::format("{}: its {} names no asset; name one, or take the component away",
                                 world.describe(entity), use)};
    const MeshAsset& mesh = assets.mesh(asset);
    if (mesh.field && mesh.field->kind == kind)
        return {};
    return Error{
        fmt::format("{}: '{}' cannot be its {}, it has no {} field; {}", world.describe(entity),
                    mesh.name, use, kind == FieldKind::Radiance ? "radiance" : "occlusion",
                    kind == FieldKind::Radiance ? "compile a light description with assetc light"
                                                : "bake it with assetc bake without --no-field")};
}

template <class Component>
void addIndices(ecs::World& world, const std::vector<ecs::Entity>& entities)
{
    for (std::uint32_t i = 0; i < entities.size(); ++i)
        world.add(entities[i], Component{i});
}

template <class Place>
void place(Place& at, const Transform& transform)
{
    at.position = transform.position;
    at.scale = transform.scale;
    at.rotation = transform.rotation;
}

// `Index`: RenderInstance or RenderLight.
template <class Index>
void gatherMoved(const ecs::SystemContext& context, std::vector<SceneChanges::Moved>& out)
{
    context
        .query<const Transform, const Index, ecs::Changed<Transform>,
               ecs::Without<WorldTransform>>()
        .each([&](const Transform& transform, const Index& entity) {
            out.push_back({entity.index, transform});
        });
    context.query<const WorldTransform, const Index, ecs::Changed<WorldTransform>>().each(
        [&](const WorldTransform& transform, const Index& entity) {
            out.push_back({entity.index, transform.at});
        });
}

MeshMaterial meshMaterial(const Material& material)
{
    return {material.albedo, material.glossFraction, material.glossExponent};
}

} // namespace

Result<SceneData> extractScene(ecs::World& world, const AssetStore& assets)
{
    addWorldTransforms(world);
    std::vector<SceneInstance> instances;
    std::vector<SceneLight> lights;
    std::vector<ecs::Entity> instanceEntities, lightEntities;
    Result<void> failed;
    const auto need = [&](ecs::Entity entity, AssetHandle asset, FieldKind kind,
                          std::string_view use) {
        if (Result<void> has = needField(world, entity, assets, asset, kind, use); !has && failed)
            failed = has;
    };
    world.query<const Transform, const MeshInstance>().each(
        [&](ecs::Entity entity, const Transform&, const MeshInstance& mesh) {
            if (!assets.hasMesh(mesh.asset)) {
                if (failed)
                    failed =
                        Error{world.describe(entity) + ": its MeshInstance names no asset; name "
                                                       "one, or take the component away"};
                return;
            }
            if (const float scale = worldTransform(world, entity).scale;
                !(scale >= kMinScale && scale <= kMaxScale) && failed)
                failed = Error{fmt::format("{}: its scale in the world is {}, allowed {} to {}; "
                                           "scale it, or what it hangs on",
                                           world.describe(entity), scale, kMinScale, kMaxScale)};
            SceneInstance instance;
            instance.mesh = mesh.asset.index;
            place(instance, worldTransform(world, entity));
            instance.material = assets.mesh(mesh.asset).material;
            if (const Material* material = world.tryGet<const Material>(entity)) {
                instance.material = meshMaterial(*material);
                instance.repainted = true;
            }
            if (const auto* occluder = world.tryGet<const ShadowFieldOccluder>(entity)) {
                need(entity, occluder->asset, FieldKind::Occlusion, "occluder");
                instance.occluder = occluder->asset.index;
            }
            const auto* emitter = world.tryGet<const ShadowFieldEmitter>(entity);
            instance.emission = emitter ? emitter->intensity : vec3(1);
            instances.push_back(instance);
            instanceEntities.push_back(entity);
        });
    if (!failed)
        return failed.error();
    addIndices<RenderInstance>(world, instanceEntities);
    world.query<const Transform, const ShadowFieldEmitter>().each(
        [&](ecs::Entity entity, const Transform&, const ShadowFieldEmitter& emitter) {
            need(entity, emitter.asset, FieldKind::Radiance, "emitter");
            SceneLight light;
            light.asset = emitter.asset.index;
            place(light, worldTransform(world, entity));
            light.intensity = emitter.intensity;
            if (const auto* owner = world.tryGet<const RenderInstance>(entity)) {
                light.owner = owner->index;
                if (instances[owner->index].mesh != light.asset && failed)
                    failed = Error{world.describe(entity) + ": shows another mesh than that of "
                                                            "its emitter; give both one asset"};
            }
            lights.push_back(light);
            lightEntities.push_back(entity);
        });
    addIndices<RenderLight>(world, lightEntities);
    world.query<const EnvironmentLight>().each(
        [&](ecs::Entity entity, const EnvironmentLight& light) {
            if (!assets.hasEnvironment(light.asset) && failed)
                failed = Error{world.describe(entity) + ": its EnvironmentLight names no "
                                                        "environment; compile one with assetc "
                                                        "environment"};
        });
    if (failed && instances.empty())
        failed = Error{"the scene shows nothing; give an entity a Transform and a MeshInstance"};
    if (!failed)
        return failed.error();
    SceneData data = buildSceneData(assets.meshes(), std::move(instances), std::move(lights));
    for (SurfaceImage& image : data.surfaces.images)
        if (const std::string& path = assets.path({image.mesh}); !path.empty())
            image.place = path + ": " + image.place;
    return data;
}

void SceneChanges::clear()
{
    instances.clear();
    lights.clear();
    materials.clear();
    intensities.clear();
    relit = false;
}

void gatherChanged(const ecs::SystemContext& context, SceneChanges& out)
{
    gatherMoved<RenderInstance>(context, out.instances);
    gatherMoved<RenderLight>(context, out.lights);
    context.query<const Material, const RenderInstance, ecs::Changed<Material>>().each(
        [&](const Material& material, const RenderInstance& instance) {
            out.materials.push_back({instance.index, material});
        });
    context.query<const ShadowFieldEmitter, const RenderLight, ecs::Changed<ShadowFieldEmitter>>()
        .each([&](const ShadowFieldEmitter& emitter, const RenderLight& light) {
            out.intensities.push_back({light.index, emitter.intensity});
        });

    // They are few, and the frame needs their sum: all, if one changed, came or went.
    const auto environments = context.query<const EnvironmentLight>();
    out.relit |= out.environments.size() != environments.count();
    context.query<ecs::Changed<EnvironmentLight>>().each([&](ecs::Entity) { out.relit = true; });
    if (out.relit) {
        out.environments.clear();
        environments.each(
            [&](const EnvironmentLight& light) { out.environments.push_back(light); });
    }
}

void applyChanges(const SceneChanges& changes, GpuScene& scene)
{
    const auto edit = [&](std::uint32_t index, const auto& change) {
        SceneInstance instance = scene.data().instances[index];
        change(instance);
        scene.setInstance(index, instance);
    };
    const auto editLight = [&](std::uint32_t index, const auto& change) {
        SceneLight light = scene.data().lights[index];
        change(light);
        scene.setLight(index, light);
    };
    for (const auto& [index, transform] : changes.instances)
        edit(index, [&, &at = transform](SceneInstance& instance) { place(instance, at); });
    for (const auto& [index, material] : changes.materials)
        edit(index, [&, &look = material](SceneInstance& instance) {
            instance.material = meshMaterial(look);
            instance.repainted = true;
        });
    for (const auto& [index, transform] : changes.lights)
        editLight(index, [&, &at = transform](SceneLight& light) { place(light, at); });
    for (const auto& [index, intensity] : changes.intensities) {
        editLight(index, [&, factor = intensity](SceneLight& light) { light.intensity = factor; });
        if (const auto& owner = scene.data().lights[index].owner)
            edit(*owner,
                 [&, factor = intensity](SceneInstance& surface) { surface.emission = factor; });
    }
}

} // namespace penumbra
