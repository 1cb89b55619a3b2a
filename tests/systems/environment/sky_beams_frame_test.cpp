// Shadows of beams in a frame on the GPU, against geometry: a ball over a floor, under a lamp.
#include "systems/frame.h"

#include "runtime/vk/transfer.h"
#include "systems/environment_lighting.h"
#include "tests/support/gpu_fixture.h"
#include "tests/systems/environment/test_skies.h"
#include "tests/systems/shadow_fields/test_scene.h"

#include <glm/gtc/matrix_transform.hpp>

namespace penumbra {
namespace {

constexpr float kBall = 0.3f;
const vec3 kBallAt(0.2f, 0.8f, -0.1f);
const vec3 kLamp = normalize(vec3(0.5f, 1, 0.3f));
constexpr float kLampAngle = 0.06f;

class SkyBeamsFrameTest : public GpuTest {
protected:
    static const std::vector<MeshAsset>& assets()
    {
        static const std::vector<MeshAsset> kAssets = {makeBoxAsset(vec3(2, 0.05f, 2), 40, false),
                                                       makeSphereAsset(kBall, 24)};
        return kAssets;
    }

    static SceneData sceneOf(bool ball)
    {
        std::vector<SceneInstance> instances = {
            {.mesh = 0, .position = vec3(0, -0.05f, 0), .material = {vec3(0.8f), 0, 0}}};
        if (ball)
            instances.push_back(
                {.mesh = 1, .position = kBallAt, .material = {vec3(0.8f), 0, 0}, .occluder = 1});
        const MeshAsset* const meshes[] = {&assets()[0], &assets()[1]};
        return buildSceneData(meshes, instances);
    }

    void SetUp() override
    {
        GpuTest::SetUp();
        m_passes = take(createFramePasses(device(), {}));
        m_map = m_store.addEnvironment(makeSky(256, 128, [](vec3 d) {
            return vec3(0.05f) + (dot(d, kLamp) > std::cos(kLampAngle) ? vec3(60) : vec3(0));
        }));
    }

    void TearDown() override
    {
        m_passes = {};
        GpuTest::TearDown();
    }

    // Radiance of all receivers. `turn` of the whole sky.
    std::vector<vec4> draw(bool ball, std::uint32_t beams, vec4 turn = vec4(0, 0, 0, 1),
                           Kernel kernel = Kernel::Exact, SceneData* moved = nullptr)
    {
        FrameTargets targets = take(createFrameTargets(device(), m_passes, {160, 120}));
        GpuScene gpu = take(
            GpuScene::create(device(), moved != nullptr ? *moved : sceneOf(ball), {}, 2, beams));
        FrameRing ring(device());
        EnvironmentLighting lighting(m_store, false, beams);
        lighting.set(std::vector<EnvironmentLight>{{m_map, 1, turn}});
        gpu.setBeams(lighting.beams());
        View view;
        view.eye = vec3(0, 5, 3);
        view.clipFromWorld = glm::perspectiveRH_ZO(1.0f, 4.0f / 3, 0.05f, 100.0f) *
                             glm::lookAtRH(view.eye, vec3(0), vec3(0, 1, 0));
        FrameConstants constants = frameConstants(view, lighting.light());
        constants.culls = 0;
        for (int i = 0; i < 2; ++i) {
            const GpuFrame frame = take(ring.beginFrame());
            recordFrame(frame, m_passes, gpu, constants, {.kernel = kernel}, targets);
            take(ring.endFrame());
            if (i == 0 && m_ballInSecondFrame)
                gpu.setInstance(1, *m_ballInSecondFrame);
        }
        take(ring.waitIdle());
        return take(readBackAs<vec4>(device(), gpu.buffers().radiance));
    }

    // Of the floor's upper side.
    template <class F>
    void eachOnFloor(F&& visit) const
    {
        const MeshAsset& floor = assets()[0];
        for (std::size_t v = 0; v < floor.positions.size(); ++v)
            if (floor.normals[v].y > 0.9f)
                visit(v, floor.positions[v] + vec3(0, -0.05f, 0));
    }

    FramePasses m_passes;
    AssetStore m_store;
    AssetHandle m_map;
    std::optional<SceneInstance> m_ballInSecondFrame;
};

float blockedAngle(vec3 from, vec3 lamp)
{
    const vec3 to = kBallAt - from;
    return std::acos(dot(normalize(to), lamp)) - std::asin(kBall / length(to));
}

// A receiver sees the whole lamp, none of it, or a part: the lamp's light is whole, gone, or
// between, and the fields of order 4 can do none of this.
TEST_F(SkyBeamsFrameTest, TheShadowOfABallHasASharpEdge)
{
    for (const vec4 turn : {vec4(0, 0, 0, 1), yaw(2.1f)}) {
        const vec3 lamp = rotate(turn, kLamp);
        for (const Kernel kernel : {Kernel::Exact, Kernel::Literal}) {
            const std::vector<vec4> open = draw(false, 16, turn, kernel);
            const std::vector<vec4> with = draw(true, 16, turn, kernel);
            const std::vector<vec4> fields = draw(true, 0, turn, kernel);
            // What the lamp alone gives where nothing stands in its way.
            const float whole = 0.8f * kLampAngle * kLampAngle * 60 * lamp.y;
            int lit = 0, dark = 0;
            float worstLit = 0, worstDark = 0, fieldsDark = 0;
            eachOnFloor([&](std::size_t v, vec3 p) {
                const float angle = blockedAngle(p, lamp);
                const float lost = (open[v].g - with[v].g) / whole;
                if (angle > 2 * kLampAngle) {
                    ++lit;
                    worstLit = std::max(worstLit, lost);
                } else if (angle < -2 * kLampAngle) {
                    ++dark;
                    worstDark = std::max(worstDark, 1 - lost);
                    fieldsDark = std::max(fieldsDark, 1 - (open[v].g - fields[v].g) / whole);
                }
            });
            EXPECT_GT(lit, 1000);
            EXPECT_GT(dark, 10);
            // The rest of the sky is shadowed as well: it gives a quarter of the lamp's light.
            EXPECT_LT(worstLit, 0.05f);
            EXPECT_LT(worstDark, 0.05f);
            EXPECT_GT(fieldsDark, 0.3f);
        }
    }
}

TEST_F(SkyBeamsFrameTest, AMatteFloorGetsTheLightOfTheSky)
{
    const std::vector<vec4> with = draw(false, 16), without = draw(false, 0);
    eachOnFloor([&](std::size_t v, vec3) { ASSERT_NEAR(with[v].g / without[v].g, 1, 0.03f); });
}

TEST_F(SkyBeamsFrameTest, ABallHasNoAcne)
{
    const SceneData data = sceneOf(true);
    SceneData alone = data;
    alone.instances[1].occluder.reset();
    const std::vector<vec4> with = draw(true, 16);
    const std::vector<vec4> without = draw(true, 16, vec4(0, 0, 0, 1), Kernel::Exact, &alone);
    const MeshAsset& ball = assets()[1];
    int lit = 0;
    for (std::size_t v = 0; v < ball.positions.size(); ++v) {
        const float cosine = dot(ball.normals[v], kLamp);
        if (cosine < 0.15f)
            continue;
        const std::uint32_t at = data.firstRadiance[1] + static_cast<std::uint32_t>(v);
        ASSERT_GT(with[at].g, 0.97f * without[at].g) << cosine;
        ++lit;
    }
    EXPECT_GT(lit, 200);
}

// A floor that mirrors the lamp as Phong's lobe says; every exponent down to 0 is allowed.
TEST_F(SkyBeamsFrameTest, BluntGlossShowsTheLamp)
{
    for (const float exponent : {0.0f, 2.0f, 40.0f}) {
        SceneData data = sceneOf(false);
        data.instances[0].material = {vec3(0.8f), 1, exponent};
        const std::vector<vec4> with = draw(false, 16, vec4(0, 0, 0, 1), Kernel::Exact, &data);
        const vec3 eye(0, 5, 3);
        float brightest = 0, worst = 0;
        eachOnFloor([&](std::size_t v, vec3 p) {
            const float along =
                std::max(dot(reflect(normalize(p - eye), vec3(0, 1, 0)), kLamp), 0.0f);
            const float wanted = 0.8f * kLampAngle * kLampAngle * 60 * kLamp.y * 0.5f *
                                 (exponent + 2) * std::pow(along, exponent);
            const float rest = 0.8f * 0.05f; // about, of the sky
            worst = std::max(worst, std::abs(with[v].g - rest - wanted));
            brightest = std::max(brightest, wanted);
            ASSERT_TRUE(std::isfinite(with[v].g));
        });
        EXPECT_LT(worst, 0.15f * brightest + 0.02f) << exponent;
    }
}

TEST_F(SkyBeamsFrameTest, ABallThatStopsBlockingLosesItsShadow)
{
    SceneData alone = sceneOf(true);
    alone.instances[1].occluder.reset();
    const std::vector<vec4> without = draw(true, 16, vec4(0, 0, 0, 1), Kernel::Exact, &alone);
    EXPECT_NE(draw(true, 16), without);
    m_ballInSecondFrame = alone.instances[1];
    EXPECT_EQ(draw(true, 16), without);
}

TEST_F(SkyBeamsFrameTest, FramesRepeatBitByBit)
{
    EXPECT_EQ(draw(true, 16), draw(true, 16));
}

// In steps of 1 mm no receiver changes by more than the edge of one beam of 16, softened by 8 taps,
// may: an eighth of its light each, and the beams' edges do not fall together.
TEST_F(SkyBeamsFrameTest, AMovingBallCausesNoJump)
{
    const float whole = 0.8f * kLampAngle * kLampAngle * 60 * kLamp.y;
    SceneData data = sceneOf(true);
    std::vector<vec4> before = draw(true, 16, vec4(0, 0, 0, 1), Kernel::Exact, &data);
    float largest = 0, changed = 0;
    for (int step = 0; step < 6; ++step) {
        data.instances[1].position.x += 1e-3f;
        const std::vector<vec4> now = draw(true, 16, vec4(0, 0, 0, 1), Kernel::Exact, &data);
        eachOnFloor([&](std::size_t v, vec3) {
            largest = std::max(largest, std::abs(now[v].g - before[v].g) / whole);
            changed += std::abs(now[v].g - before[v].g) / whole;
        });
        before = now;
    }
    EXPECT_GT(changed, 0.5f);
    EXPECT_LT(largest, 0.1f);
}

} // namespace
} // namespace penumbra
