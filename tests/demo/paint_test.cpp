// Materials that change while the demo runs: by a key, and by themselves.
#include "demo/gloss_cycle.h"
#include "demo/paint.h"
#include "demo/simulation.h"

#include <gtest/gtest.h>

namespace penumbra {
namespace {

// A box of 1 m with its corner at the origin: only its bounds matter here.
MeshAsset makeBox()
{
    MeshAsset mesh;
    mesh.boundsMax = vec3(1);
    return mesh;
}

class Paint : public ::testing::Test {
protected:
    ecs::Entity add(const Transform& at, const Material& material)
    {
        const ecs::Entity entity = m_scene.world.create(at, MeshInstance{m_box}, material);
        return entity;
    }

    DemoScene m_scene;
    AssetHandle m_box = m_scene.assets.addMesh(makeBox());
    View m_view = viewOf({.target = vec3(0), .distance = 10, .pitch = 0}, 1); // along -z
};

TEST_F(Paint, PicksWhatComesFirst)
{
    const ecs::Entity far = add({.position = vec3(-0.5f, -0.5f, -3)}, {});
    const ecs::Entity near = add({.position = vec3(-0.5f, -0.5f, 1), .scale = 0.6f}, {});
    const quat turn = glm::angleAxis(0.7f, vec3(0, 1, 0));
    const ecs::Entity turned =
        add({vec3(2, -0.5f, 0), 1, vec4(turn.x, turn.y, turn.z, turn.w)}, {});
    EXPECT_EQ(pick(m_scene, m_view, vec2(0)), near);
    EXPECT_EQ(pick(m_scene, m_view, vec2(0.1f, 0.1f)), far);
    const vec4 middle = m_view.clipFromWorld * vec4(vec3(2, -0.5f, 0) + turn * vec3(0.5f), 1);
    EXPECT_EQ(pick(m_scene, m_view, vec2(middle) / middle.w), turned);
    EXPECT_EQ(pick(m_scene, m_view, vec2(0, 0.9f)), std::nullopt);
}

TEST_F(Paint, KeysChangeThePickedMaterialAndTheRendererHears)
{
    const ecs::Entity box = add({.position = vec3(-0.5f)}, {vec3(0.3f), 0, 4});
    m_scene.world.add(box, RenderInstance{7});
    Simulation simulation(m_scene);
    simulation.advance(0);
    EXPECT_TRUE(simulation.advance(0).materials.empty());
    EXPECT_FALSE(paint(m_scene, m_view, vec2(0), {}));
    EXPECT_FALSE(paint(m_scene, m_view, vec2(0.9f), {.toggle = true})); // nothing there
    EXPECT_TRUE(paint(m_scene, m_view, vec2(0), {.toggle = true, .factor = 4}));
    const std::vector<SceneChanges::Repainted> changed = simulation.advance(0).materials;
    ASSERT_EQ(changed.size(), 1u);
    EXPECT_EQ(changed[0].index, 7u);
    EXPECT_EQ(changed[0].material.albedo, vec3(0.3f));
    EXPECT_GT(changed[0].material.glossFraction, 0);
    EXPECT_EQ(changed[0].material.glossExponent, 16);
}

TEST_F(Paint, ACycleChangesTheExponentEveryFrame)
{
    const GlossCycle cycle{.low = 2, .high = 32, .period = 4};
    EXPECT_FLOAT_EQ(exponentAt(cycle, 0), 2);
    EXPECT_FLOAT_EQ(exponentAt(cycle, 1), 8);
    EXPECT_FLOAT_EQ(exponentAt(cycle, 2), 32);
    EXPECT_FLOAT_EQ(exponentAt(cycle, 400), 2);
    const ecs::Entity box = add({}, {vec3(0.3f), 0.5f, 2});
    m_scene.world.add(box, RenderInstance{0});
    m_scene.world.add(box, cycle);
    Simulation simulation(m_scene);
    simulation.advance(1);
    const std::vector<SceneChanges::Repainted> changed = simulation.advance(1).materials;
    ASSERT_EQ(changed.size(), 1u);
    EXPECT_FLOAT_EQ(changed[0].material.glossExponent, 32);
}

} // namespace
} // namespace penumbra
