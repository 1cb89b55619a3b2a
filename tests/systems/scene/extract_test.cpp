#include "systems/extract.h"
#include "tests/assets/sample_assets.h"

#include "runtime/ecs/name.h"
#include "runtime/ecs/schedule.h"
#include "systems/transforms.h"

#include <gtest/gtest.h>

namespace penumbra {
namespace {

MeshAsset lightAsset()
{
    MeshAsset mesh = sampleMesh(4);
    mesh.name = "lamp";
    mesh.field = sampleField();
    mesh.field->kind = FieldKind::Radiance;
    mesh.field->channels = 3;
    mesh.field->texels.assign(fieldTexelBytes(*mesh.field), 100);
    return mesh;
}

class Extract : public testing::Test {
protected:
    AssetStore m_assets;
    AssetHandle m_block = m_assets.addMesh(sampleAsset(4));
    AssetHandle m_plain = m_assets.addMesh(sampleMesh(4));
    AssetHandle m_lamp = m_assets.addMesh(lightAsset());
    ecs::World m_world;
};

TEST_F(Extract, GivesInstancesLightsAndTheirOwners)
{
    m_world.create(Transform{.position = {1, 2, 3}, .scale = 2}, MeshInstance{m_block},
                   ShadowFieldOccluder{m_block});
    const ecs::Entity lamp = m_world.create(Transform{.position = {0, 4, 0}}, MeshInstance{m_lamp},
                                            ShadowFieldEmitter{m_lamp, vec3(2, 3, 4)});
    m_world.create(Transform{.position = {5, 0, 0}, .scale = 3},
                   ShadowFieldEmitter{m_lamp, vec3(1)}); // without a surface
    Result<SceneData> data = extractScene(m_world, m_assets);
    ASSERT_TRUE(data) << data.error().message;
    ASSERT_EQ(data->instances.size(), 2u);
    ASSERT_EQ(data->lights.size(), 2u);
    const std::uint32_t surface = m_world.get<const RenderInstance>(lamp).index;
    const SceneLight& owned = data->lights[m_world.get<const RenderLight>(lamp).index];
    EXPECT_EQ(owned.owner, surface);
    EXPECT_EQ(owned.intensity, vec3(2, 3, 4));
    EXPECT_EQ(data->instances[surface].emission, vec3(2, 3, 4));
    EXPECT_FALSE(data->instances[surface].occluder);
    const SceneLight& bare = data->lights[1 - m_world.get<const RenderLight>(lamp).index];
    EXPECT_FALSE(bare.owner);
    EXPECT_EQ(bare.position, vec3(5, 0, 0));
    EXPECT_EQ(bare.scale, 3);
}

TEST_F(Extract, NamesTheEntityWhoseAssetHasNoSuchField)
{
    const auto error = [&](auto&&... components) {
        ecs::World world;
        world.create(ecs::Name("culprit"), Transform{}, components...);
        const Result<SceneData> data = extractScene(world, m_assets);
        return data ? std::string() : data.error().message;
    };
    for (const std::string& message :
         {error(MeshInstance{m_plain}, ShadowFieldOccluder{m_plain}),
          error(MeshInstance{m_block}, ShadowFieldOccluder{m_lamp}),
          error(ShadowFieldEmitter{m_block}), error(ShadowFieldEmitter{m_plain}),
          error(MeshInstance{}), error(MeshInstance{m_block}, ShadowFieldOccluder{}),
          error(ShadowFieldEmitter{}), error(MeshInstance{m_block}, ShadowFieldEmitter{m_lamp})}) {
        EXPECT_NE(message.find("culprit"), std::string::npos) << message;
    }
}

TEST_F(Extract, ScalesAreBoundedInTheWorld)
{
    ecs::Entity parent = m_world.create(Transform{.scale = 1e-4f});
    for (int i = 0; i < 2; ++i) {
        const ecs::Entity child = m_world.create(ecs::Name(i == 0 ? "small" : "culprit"),
                                                 Transform{.scale = 1e-2f}, MeshInstance{m_block});
        ASSERT_TRUE(m_world.setParent(child, parent));
        parent = child;
    }
    const Result<SceneData> data = extractScene(m_world, m_assets);
    ASSERT_FALSE(data);
    EXPECT_NE(data.error().message.find("culprit"), std::string::npos) << data.error().message;
}

TEST_F(Extract, GathersOnlyWhatChanged)
{
    const ecs::Entity block = m_world.create(Transform{}, MeshInstance{m_block}, Material{},
                                             ShadowFieldOccluder{m_block});
    m_world.create(Transform{}, MeshInstance{m_plain});
    const ecs::Entity lamp = m_world.create(Transform{}, ShadowFieldEmitter{m_lamp, vec3(1)});
    ASSERT_TRUE(extractScene(m_world, m_assets));
    SceneChanges changes;
    ecs::Schedule schedule(m_world, {"extract"});
    schedule.add<const Transform, const WorldTransform, const Material, const ShadowFieldEmitter,
                 const EnvironmentLight, const RenderInstance, const RenderLight>(
        "gather", "extract", [&](ecs::SystemContext& context) { gatherChanged(context, changes); });
    const auto run = [&] {
        changes.clear();
        schedule.run();
    };
    run(); // all is new
    EXPECT_EQ(changes.instances.size(), 2u);
    EXPECT_EQ(changes.lights.size(), 1u);
    EXPECT_EQ(changes.intensities.size(), 1u);
    run();
    EXPECT_TRUE(changes.instances.empty() && changes.lights.empty() && changes.materials.empty() &&
                changes.intensities.empty());

    m_world.get<Transform>(lamp).position = {7, 0, 0};
    m_world.get<Material>(block).glossExponent = 40;
    run();
    EXPECT_TRUE(changes.instances.empty());
    ASSERT_EQ(changes.lights.size(), 1u);
    EXPECT_EQ(changes.lights[0].index, m_world.get<const RenderLight>(lamp).index);
    EXPECT_EQ(changes.lights[0].transform.position, vec3(7, 0, 0));
    ASSERT_EQ(changes.materials.size(), 1u);
    EXPECT_EQ(changes.materials[0].material.glossExponent, 40);

    m_world.get<ShadowFieldEmitter>(lamp).intensity = vec3(0, 1, 0);
    run();
    ASSERT_EQ(changes.intensities.size(), 1u);
    EXPECT_EQ(changes.intensities[0].intensity, vec3(0, 1, 0));
    EXPECT_TRUE(changes.lights.empty());
}

} // namespace
} // namespace penumbra
