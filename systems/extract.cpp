#include "systems/extract.h"

namespace penumbra {

SceneData extractScene(ecs::World& world, const AssetStore& assets)
{
    std::vector<SceneInstance> instances;
    std::vector<ecs::Entity> entities;
    world.query<const Transform, const MeshInstance>().each(
        [&](ecs::Entity entity, const Transform& transform, const MeshInstance& mesh) {
            SceneInstance instance;
            instance.mesh = mesh.asset.index;
            instance.position = transform.position;
            instance.scale = transform.scale;
            instance.rotation = transform.rotation;
            instance.material = assets.mesh(mesh.asset).material;
            if (const Material* material = world.tryGet<const Material>(entity))
                instance.material = {material->albedo, material->glossFraction,
                                     material->glossExponent};
            instance.occluder = world.has<ShadowFieldOccluder>(entity);
            instances.push_back(instance);
            entities.push_back(entity);
        });
    for (std::uint32_t i = 0; i < entities.size(); ++i)
        world.add(entities[i], RenderInstance{i});
    return buildSceneData(assets.meshes(), std::move(instances));
}

void gatherChanged(const ecs::SystemContext& context, std::vector<ChangedInstance>& out)
{
    context.query<const Transform, const RenderInstance, ecs::Changed<Transform>>().each(
        [&](const Transform& transform, const RenderInstance& instance) {
            out.push_back({instance.index, transform});
        });
}

} // namespace penumbra
