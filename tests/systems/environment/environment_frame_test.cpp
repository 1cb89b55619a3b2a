// Environments in a frame on the GPU: cross-fades, and the map drawn where its light comes from.
#include "systems/frame.h"

#include "runtime/vk/transfer.h"
#include "systems/environment_lighting.h"
#include "tests/support/gpu_fixture.h"
#include "tests/systems/environment/test_skies.h"
#include "tests/systems/shadow_fields/test_scene.h"

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>

namespace penumbra {
namespace {

constexpr VkExtent2D kExtent{160, 120};

struct Drawn {
    std::vector<vec4> radiance; // of the receivers
    std::vector<vec3> picture;  // [height][width] linear
    std::vector<std::byte> display;
};

using Lights = std::vector<EnvironmentLight>;

class EnvironmentFrameTest : public GpuTest {
protected:
    static const TestScene& scene()
    {
        static const TestScene kScene = makeTestScene();
        return kScene;
    }

    void SetUp() override
    {
        GpuTest::SetUp();
        m_passes = take(createFramePasses(device(), {}));
        m_day = m_store.addEnvironment(makeSky(64, 32, lopsided));
        m_dusk = m_store.addEnvironment(makeSky(128, 64, evening));
        m_dawn = m_store.addEnvironment(makeSky(16, 8, [](vec3 d) { return lopsided(-d); }));
    }

    // The frames one after the other, without a pause; what the last one shows.
    Drawn draw(const std::vector<Lights>& frames, const View& view)
    {
        FrameTargets targets = take(createFrameTargets(device(), m_passes, kExtent));
        GpuScene gpu = take(GpuScene::create(device(), scene().data, {}, 2));
        FrameRing ring(device());
        EnvironmentLighting lighting(m_store, false);
        for (const Lights& lights : frames) {
            lighting.set(lights);
            take(gpu.setBackground(lighting.background()));
            const GpuFrame frame = take(ring.beginFrame());
            recordFrame(frame, m_passes, gpu, frameConstants(view, lighting.light()), {}, targets);
            take(ring.endFrame());
        }
        take(ring.waitIdle());
        Drawn drawn;
        drawn.radiance = take(readBackAs<vec4>(device(), gpu.buffers().radiance));
        drawn.display =
            take(readBack(device(), targets.display, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL));
        const std::vector<std::byte> halves =
            take(readBack(device(), targets.radiance, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL));
        for (std::size_t i = 0; i < halves.size(); i += 8) {
            std::uint64_t packed = 0;
            std::memcpy(&packed, &halves[i], 8);
            drawn.picture.push_back(vec3(glm::unpackHalf4x16(packed)));
        }
        return drawn;
    }

    void TearDown() override
    {
        m_passes = {};
        GpuTest::TearDown();
    }

    FramePasses m_passes;
    AssetStore m_store;
    AssetHandle m_day, m_dusk, m_dawn;
};

// Both the light of the receivers and the picture behind them.
TEST_F(EnvironmentFrameTest, ACrossFadeIsTheWeightedSum)
{
    const vec4 turn = turnAbout(vec3(0.2f, 1, 0.1f), 2.0f);
    const auto faded = [&](float w) {
        return draw({{{m_day, 1 - w, yaw(0.4f)}, {m_dusk, w, turn}}}, scene().view);
    };
    const Drawn day = draw({{{m_day, 1, yaw(0.4f)}}}, scene().view);
    const Drawn dusk = draw({{{m_dusk, 1, turn}}}, scene().view);
    const Drawn none = faded(0), half = faded(0.5f), all = faded(1);
    EXPECT_EQ(none.radiance, day.radiance);
    EXPECT_EQ(none.picture, day.picture);
    EXPECT_EQ(all.radiance, dusk.radiance);
    EXPECT_EQ(all.picture, dusk.picture);
    EXPECT_NE(day.picture, dusk.picture);
    EXPECT_GT(day.picture.front().g, 0.05f); // a corner shows the sky

    float brightest = 0, difference = 0;
    for (std::size_t i = 0; i < half.radiance.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            brightest = std::max(brightest, half.radiance[i][c]);
            difference =
                std::max(difference, std::abs(half.radiance[i][c] -
                                              0.5f * (day.radiance[i][c] + dusk.radiance[i][c])));
        }
    EXPECT_GT(brightest, 0.2f);
    EXPECT_LT(difference, 1e-5f * brightest); // the sums are taken in another order
    for (std::size_t i = 0; i < half.picture.size(); ++i) {
        const vec3 wanted = 0.5f * (day.picture[i] + dusk.picture[i]);
        for (int c = 0; c < 3; ++c) // half floats: 2^-11, and each of the two was rounded, too
            ASSERT_NEAR(half.picture[i][c], wanted[c], 1.1e-3f * wanted[c] + 1e-4f) << i;
    }
}

// Looks up into the sky, off the lamp in both directions.
View towards(vec3 direction)
{
    const vec3 side = normalize(cross(direction, vec3(0, 1, 0)));
    const vec3 ahead = normalize(direction + 0.22f * side - 0.13f * cross(side, direction));
    View view;
    view.eye = vec3(0, 4, 0);
    view.clipFromWorld = glm::perspectiveRH_ZO(1.2f, 4.0f / 3, 0.05f, 100.0f) *
                         glm::lookAtRH(view.eye, view.eye + ahead, vec3(0, 1, 0));
    return view;
}

// The unit direction of the brightest pixels.
vec3 brightestDirection(const Drawn& drawn, const View& view)
{
    float brightest = 0;
    for (const vec3& c : drawn.picture)
        brightest = std::max(brightest, c.g);
    vec3 sum(0);
    for (std::uint32_t i = 0; i < drawn.picture.size(); ++i) {
        if (drawn.picture[i].g < 0.7f * brightest)
            continue;
        const vec2 ndc = 2.0f * (vec2(i % kExtent.width, i / kExtent.width) + 0.5f) /
                             vec2(kExtent.width, kExtent.height) -
                         1.0f;
        const vec4 far = glm::inverse(view.clipFromWorld) * vec4(ndc.x, -ndc.y, 1, 1);
        sum += normalize(vec3(far) / far.w - view.eye);
    }
    return normalize(sum);
}

// A lamp in the map: drawn in the direction that the rotation gives it, and the shadow of a ball on
// the floor lies on the other side.
TEST_F(EnvironmentFrameTest, TheLampIsDrawnWhereItsShadowsSay)
{
    const vec3 lamp = normalize(vec3(0.8f, 0.75f, 0.35f)); // in the map
    const AssetHandle map = m_store.addEnvironment(makeSky(256, 128, [&](vec3 d) {
        return vec3(0.05f) + (dot(d, lamp) > std::cos(0.08f) ? vec3(60) : vec3(0));
    }));
    const std::vector<MeshAsset> assets = {makeBoxAsset(vec3(2, 0.05f, 2), 40, false),
                                           makeSphereAsset(0.3f, 16)};
    const MeshAsset* const meshes[] = {&assets[0], &assets[1]};
    const std::vector<SceneInstance> instances = {
        {.mesh = 0, .position = vec3(0, -0.05f, 0)},
        {.mesh = 1, .position = vec3(0, 0.35f, 0), .occluder = 1}};
    const SceneData shadowed = buildSceneData(meshes, instances);
    const SceneData open = buildSceneData(meshes, {instances[0]});

    for (const vec4 turn :
         {vec4(0, 0, 0, 1), yaw(1.9f), yaw(-0.8f), turnAbout(vec3(0.3f, 1, -0.2f), 2.6f)}) {
        const vec3 direction = rotate(turn, lamp);
        ASSERT_GT(direction.y, 0.3f); // above the horizon in all cases
        const View view = towards(direction);
        const Drawn drawn = draw({{{map, 1, turn}}}, view);
        EXPECT_GT(dot(brightestDirection(drawn, view), direction), std::cos(0.02f));

        EnvironmentLighting lighting(m_store, false);
        lighting.set(Lights{{map, 1, turn}});
        const FrameConstants frame = frameConstants({}, lighting.light());
        const std::vector<vec4> with = shadeAll(Kernel::Exact, shadowed, frame);
        const std::vector<vec4> without = shadeAll(Kernel::Exact, open, frame);
        vec2 sum(0);
        float dark = 0;
        for (std::uint32_t i = 0; i < shadowed.meshes[0].vertexCount; ++i) {
            const uvec4 bits = shadowed.receivers[i].geometry;
            const vec2 place(uintBitsToFloat(bits.x), uintBitsToFloat(bits.z));
            const float lost = std::max(without[i].g - with[i].g, 0.0f);
            sum += lost * place;
            dark += lost;
        }
        ASSERT_GT(dark, 0.1f);
        const vec2 away = -normalize(vec2(direction.x, direction.z));
        EXPECT_GT(dot(normalize(sum), away), 0.98f);
        EXPECT_GT(length(sum / dark), 0.1f); // metres: it does fall to one side
    }
}

// Maps change from frame to frame while others are in flight; validation is on.
TEST_F(EnvironmentFrameTest, FramesWithChangingSkiesRepeatBitByBit)
{
    std::vector<Lights> frames;
    for (int i = 0; i < 6; ++i) {
        const auto f = static_cast<float>(i);
        frames.push_back(
            {{m_day, 1 - 0.2f * f, yaw(0.3f * f)}, {m_dusk, 0.2f * f, yaw(-0.1f * f)}});
        if (i % 3 == 1)
            frames.back().insert(frames.back().begin(), {m_dawn, 2, yaw(f)});
        if (i % 3 == 2)
            frames.push_back({{m_dawn, 1, yaw(f)}});
    }
    const Drawn once = draw(frames, scene().view), again = draw(frames, scene().view);
    EXPECT_EQ(once.display, again.display);
    EXPECT_EQ(once.radiance, again.radiance);
    // The last frame depends on no other.
    const Drawn alone = draw({frames.back()}, scene().view);
    EXPECT_EQ(once.display, alone.display);
    // Without any sky it is dark.
    for (const vec3& c : draw({frames.back(), {}}, scene().view).picture)
        ASSERT_EQ(c, vec3(0));
}

} // namespace
} // namespace penumbra
