#include "systems/physics_system.h"

#include "runtime/ecs/name.h"
#include "runtime/ecs/schedule.h"
#include "systems/scene_components.h"
#include "tests/assets/sample_assets.h"

#include <gtest/gtest.h>

namespace penumbra {
namespace {

class Bodies : public testing::Test {
protected:
    Result<std::optional<PhysicsWorld>> build() { return buildPhysics(m_world, m_assets); }

    AssetStore m_assets;
    AssetHandle m_ball = m_assets.addMesh(sampleMesh(6)); // about 1 m in radius
    ecs::World m_world;
};

TEST_F(Bodies, FallOntoTheGroundAtTheirSize)
{
    m_world.create(Ground{});
    const ecs::Entity wall =
        m_world.create(Transform{{5, 1, 0}}, MeshInstance{m_ball}, RigidBody{.density = 0});
    const ecs::Entity small = m_world.create(Transform{{0, 2, 0}, 0.25f}, MeshInstance{m_ball},
                                             RigidBody{.shape = BodyShape::Pieces});
    m_world.create(Transform{{0, 9, 0}}, MeshInstance{m_ball}); // no body
    Result<std::optional<PhysicsWorld>> physics = build();
    ASSERT_TRUE(physics) << physics.error().message;
    ASSERT_TRUE(*physics);
    EXPECT_EQ((*physics)->bodyCount(), 3u); // with the ground
    ecs::Schedule schedule(m_world, {"simulate"});
    schedule.add<const PhysicsBody, Transform>(
        "physics", "simulate",
        [&](ecs::SystemContext& context) { stepPhysics(context, **physics, 1.0f / 60); });
    for (int frame = 0; frame < 300; ++frame)
        schedule.run();
    EXPECT_NEAR(m_world.get<const Transform>(small).position.y, 0.25f, 0.03f);
    EXPECT_EQ(m_world.get<const Transform>(wall).position, vec3(5, 1, 0));
}

TEST_F(Bodies, StartAsTheirComponentSays)
{
    const ecs::Entity ball =
        m_world.create(Transform{{0, 2, 0}}, MeshInstance{m_ball},
                       RigidBody{.velocity = {1, 0, 0}, .angularVelocity = {0, 0, 2}});
    const Result<std::optional<PhysicsWorld>> physics = build();
    ASSERT_TRUE(physics) << physics.error().message;
    const Motion motion = (*physics)->motion(m_world.get<const PhysicsBody>(ball).id);
    EXPECT_EQ(motion.velocity, vec3(1, 0, 0));
    EXPECT_EQ(motion.angularVelocity, vec3(0, 0, 2));
}

TEST_F(Bodies, NoneMakeNoPhysics)
{
    m_world.create(Transform{}, MeshInstance{m_ball});
    const Result<std::optional<PhysicsWorld>> physics = build();
    ASSERT_TRUE(physics) << physics.error().message;
    EXPECT_FALSE(*physics);
}

TEST_F(Bodies, ThatCannotMoveAreNamed)
{
    MeshAsset flat = sampleMesh(4);
    for (vec3& p : flat.positions)
        p.y = 0;
    const AssetHandle sheet = m_assets.addMesh(flat);
    const auto error = [&](auto&&... components) {
        ecs::World world;
        const ecs::Entity entity = world.create(ecs::Name("culprit"), RigidBody{}, components...);
        EXPECT_TRUE(world.setParent(world.create(Transform{}), entity)); // does not matter
        const auto physics = buildPhysics(world, m_assets);
        return physics ? std::string() : physics.error().message;
    };
    for (const std::string& message :
         {error(), error(Transform{}), error(Transform{}, MeshInstance{}),
          error(Transform{}, MeshInstance{sheet}),
          error(Transform{.scale = 1000}, MeshInstance{m_ball})}) // beyond 1e6 kg
        EXPECT_NE(message.find("culprit"), std::string::npos) << message;
    EXPECT_EQ(error(Transform{}, MeshInstance{m_ball}), "");

    const ecs::Entity hung =
        m_world.create(ecs::Name("culprit"), Transform{}, MeshInstance{m_ball}, RigidBody{});
    ASSERT_TRUE(m_world.setParent(hung, m_world.create(Transform{})));
    EXPECT_NE(build().error().message.find("culprit"), std::string::npos);
}

} // namespace
} // namespace penumbra
