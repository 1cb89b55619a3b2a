#include "systems/transforms.h"

#include "runtime/ecs/schedule.h"
#include "systems/extract.h"
#include "systems/scene_components.h"
#include "tests/assets/sample_assets.h"

#include <gtest/gtest.h>

namespace penumbra {
namespace {

vec4 aboutY(float angle)
{
    return vec4(0, std::sin(angle / 2), 0, std::cos(angle / 2));
}

void expectNear(vec3 a, vec3 b)
{
    EXPECT_NEAR(glm::length(a - b), 0, 1e-5) << a.x << " " << a.y << " " << a.z;
}

constexpr float kQuarter = 1.57079633f;

// shoulder - upper - (a joint without a mesh) - hand, and a stone that hangs on nobody.
class Arm : public testing::Test {
protected:
    void SetUp() override
    {
        ASSERT_TRUE(m_world.setParent(m_upper, m_shoulder));
        ASSERT_TRUE(m_world.setParent(m_joint, m_upper));
        ASSERT_TRUE(m_world.setParent(m_hand, m_joint));
        const Result<SceneData> data = extractScene(m_world, m_assets);
        ASSERT_TRUE(data) << data.error().message;
        m_data = *data;
        m_schedule.add<const Transform, WorldTransform>("transforms", "place",
                                                        updateWorldTransforms);
        m_schedule
            .add<const Transform, const WorldTransform, const Material, const ShadowFieldEmitter,
                 const EnvironmentLight, const RenderInstance, const RenderLight>(
                "gather", "extract",
                [&](ecs::SystemContext& context) { gatherChanged(context, m_changes); });
        run(); // all is new
    }
    void run()
    {
        m_changes.clear();
        m_schedule.run();
    }
    [[nodiscard]] Transform at(ecs::Entity entity) const { return worldTransform(m_world, entity); }

    AssetStore m_assets;
    AssetHandle m_mesh = m_assets.addMesh(sampleMesh(4));
    ecs::World m_world;
    ecs::Entity m_shoulder = m_world.create(Transform{{0, 2, 0}, 1, aboutY(kQuarter)});
    ecs::Entity m_upper = m_world.create(Transform{{1, 0, 0}, 0.5f}, MeshInstance{m_mesh});
    ecs::Entity m_joint = m_world.create(Transform{{2, 0, 0}, 1, aboutY(kQuarter)});
    ecs::Entity m_hand = m_world.create(Transform{{1, 1, 0}, 0.5f}, MeshInstance{m_mesh});
    ecs::Entity m_stone = m_world.create(Transform{{5, 0, 0}}, MeshInstance{m_mesh});
    SceneData m_data;
    SceneChanges m_changes;
    ecs::Schedule m_schedule{m_world, {"place", "extract"}};
};

TEST_F(Arm, HangsTogetherInTheWorld)
{
    // A quarter turn about y takes +x to -z and -z to -x.
    expectNear(at(m_shoulder).position, {0, 2, 0});
    expectNear(at(m_upper).position, {0, 2, -1});
    expectNear(at(m_joint).position, {0, 2, -2});
    expectNear(at(m_hand).position, {-0.5f, 2.5f, -2});
    EXPECT_FLOAT_EQ(at(m_hand).scale, 0.25f);
    expectNear(rotate(at(m_hand).rotation, vec3(1, 0, 0)), {-1, 0, 0});
    EXPECT_FALSE(m_world.has<WorldTransform>(m_stone));
    expectNear(at(m_stone).position, {5, 0, 0});
    const SceneInstance& hand =
        m_data.instances.at(m_world.get<const RenderInstance>(m_hand).index);
    expectNear(hand.position, at(m_hand).position);
    EXPECT_FLOAT_EQ(hand.scale, 0.25f);
}

TEST_F(Arm, DisabledParentsStillCarry)
{
    m_world.setEnabled(m_joint, false);
    m_world.get<Transform>(m_shoulder).position = {0, 3, 0};
    run();
    expectNear(at(m_hand).position, {-0.5f, 3.5f, -2});
}

TEST_F(Arm, WhatHangsOnAMovedEntityMovesAndNothingElse)
{
    run();
    EXPECT_TRUE(m_changes.instances.empty());

    m_world.get<Transform>(m_joint).rotation = {0, 0, 0, 1};
    run();
    ASSERT_EQ(m_changes.instances.size(), 1u); // the joint itself shows nothing
    EXPECT_EQ(m_changes.instances[0].index, m_world.get<const RenderInstance>(m_hand).index);
    expectNear(m_changes.instances[0].transform.position, {0, 2.5f, -2.5f});

    m_world.get<Transform>(m_shoulder).position = {0, 3, 0};
    m_world.get<Transform>(m_stone).position = {6, 0, 0};
    run();
    EXPECT_EQ(m_changes.instances.size(), 3u);
    expectNear(at(m_hand).position, {0, 3.5f, -2.5f});

    run();
    EXPECT_TRUE(m_changes.instances.empty());
}

} // namespace
} // namespace penumbra
