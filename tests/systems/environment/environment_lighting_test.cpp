// The sum of environments in SH: against maps that are turned pixel by pixel.
#include "systems/environment_lighting.h"

#include "tests/systems/environment/test_skies.h"
#include "tests/systems/shadow_fields/test_scene.h"

#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

namespace penumbra {
namespace {

double norm(const LightSh& light)
{
    double sum = 0;
    for (const vec3& c : light)
        sum += dot(c, c);
    return std::sqrt(sum);
}

// Relative to the norm of `b`: by Parseval, the rms difference of the radiance over the sphere.
double difference(const LightSh& a, const LightSh& b)
{
    LightSh d;
    for (std::size_t k = 0; k < d.size(); ++k)
        d[k] = a[k] - b[k];
    return norm(d) / norm(b);
}

LightSh lightOf(const AssetStore& store, std::vector<EnvironmentLight> lights, bool ground = false)
{
    EnvironmentLighting lighting(store, ground);
    lighting.set(lights);
    return lighting.light();
}

const vec4 kTurns[] = {yaw(0.7f), yaw(-2.5f), turnAbout(vec3(1, 0, 0), 0.4f),
                       turnAbout(vec3(1, -2, 0.5f), 1.1f), turnAbout(vec3(0, 1, 3), 3.0f)};

// A map of 1.4 degrees differs from the function by the mean over its pixels, on both sides: for
// lobes of sharpness 6 that is 6 / 24 * (0.025 rad)^2 = 1.5e-4 of the lobe.
TEST(EnvironmentLighting, TurnedLightIsThatOfTheTurnedMap)
{
    AssetStore store;
    const AssetHandle map = store.addEnvironment(makeSky(256, 128, lopsided));
    double largest = 0;
    for (const vec4 turn : kTurns) {
        const mat3 mapFromWorld = glm::transpose(rotationMatrix(turn));
        const Environment turned =
            makeSky(256, 128, [&](vec3 d) { return lopsided(mapFromWorld * d); });
        const LightSh light = lightOf(store, {{map, 1, turn}});
        EXPECT_LT(difference(light, turned.sh6), 2e-4);
        largest = std::max(largest, difference(light, turned.sh6));
        EXPECT_GT(difference(light, store.environment(map).sh6), 0.05); // it did turn
    }
    RecordProperty("largest", std::to_string(largest));
}

// By whole pixels, the very same numbers stand elsewhere: what is left is rounding.
TEST(EnvironmentLighting, TurnByPixelsIsExact)
{
    const Environment sky = makeSky(64, 32, lopsided);
    AssetStore store;
    const AssetHandle map = store.addEnvironment(sky);
    constexpr std::uint32_t kPixels = 11;
    // Light from d comes from the turned d: counter-clockwise from above is towards smaller
    // azimuths, that is, to the left in the map.
    std::vector<vec3> shifted(sky.map.size());
    for (std::uint32_t y = 0; y < 32; ++y)
        for (std::uint32_t x = 0; x < 64; ++x)
            shifted[y * 64 + (x + 64 - kPixels) % 64] = sky.map[y * 64 + x];
    const LightSh light = lightOf(store, {{map, 2, yaw(kPixels * 2 * glm::pi<float>() / 64)}});
    LightSh wanted = makeEnvironment(64, 32, std::move(shifted)).sh6;
    for (vec3& c : wanted)
        c *= 2;
    EXPECT_LT(difference(light, wanted), 2e-6);
}

TEST(EnvironmentLighting, LightsAddUp)
{
    AssetStore store;
    const AssetHandle day = store.addEnvironment(makeSky(64, 32, lopsided));
    const AssetHandle night = store.addEnvironment(makeSky(32, 16, evening));
    const LightSh a = lightOf(store, {{day, 1, kTurns[0]}});
    const LightSh b = lightOf(store, {{night, 1, kTurns[3]}});
    const LightSh sum = lightOf(store, {{day, 0.3f, kTurns[0]}, {night, 0.7f, kTurns[3]}});
    for (std::size_t k = 0; k < sum.size(); ++k)
        EXPECT_LT(length(sum[k] - (0.3f * a[k] + 0.7f * b[k])), 1e-6f);
    // What is gone leaves no trace, and no map to draw.
    EXPECT_EQ(lightOf(store, {{day, 1, kTurns[0]}, {night, 0, kTurns[3]}}), a);
    EXPECT_EQ(lightOf(store, {}), LightSh{});
    EnvironmentLighting lighting(store, false);
    lighting.set(std::vector<EnvironmentLight>{{night, 0}, {day, 1}});
    ASSERT_EQ(lighting.background().size(), 1u);
    EXPECT_EQ(lighting.background()[0].map, &store.environment(day));
}

// Over ground the map is cut at the world's horizon, whichever way it is turned.
TEST(EnvironmentLighting, TheHorizonStaysWhereItIs)
{
    AssetStore store;
    const AssetHandle map = store.addEnvironment(makeSky(256, 128, lopsided));
    double largest = 0;
    for (const vec4 turn : kTurns) {
        const mat3 mapFromWorld = glm::transpose(rotationMatrix(turn));
        const Environment turned =
            aboveGround(makeSky(256, 128, [&](vec3 d) { return lopsided(mapFromWorld * d); }));
        const LightSh light = lightOf(store, {{map, 1, turn}}, true);
        // A pixel that the horizon crosses counts by its part above: a step of one pixel, blurred.
        EXPECT_LT(difference(light, turned.sh6), 1e-3);
        largest = std::max(largest, difference(light, turned.sh6));
    }
    RecordProperty("largest", std::to_string(largest));
    // A turn about y needs no other cut than the upright map's.
    EXPECT_EQ(lightOf(store, {{map, 1, kTurns[0]}}, true),
              rotatedLight(aboveGround(store.environment(map)).sh6, rotationMatrix(kTurns[0])));
}

TEST(EnvironmentLighting, UprightCutIsTheUpperHalfOfTheMap)
{
    const Environment sky = makeSky(64, 32, lopsided), cut = aboveGround(sky);
    for (std::size_t i = 0; i < sky.map.size(); ++i)
        EXPECT_EQ(cut.map[i], i < sky.map.size() / 2 ? sky.map[i] : vec3(0)) << i;
    // Half a pixel lower, half of the row below is seen.
    const vec3 tilted = vec3(std::sin(glm::pi<float>() / 64), std::cos(glm::pi<float>() / 64), 0);
    const Environment leaning = aboveGround(sky, tilted);
    EXPECT_NEAR(leaning.map[16 * 64 + 32].g, 0.5f * sky.map[16 * 64 + 32].g, 2e-3f); // +x
    EXPECT_NEAR(leaning.map[15 * 64].g, 0.5f * sky.map[15 * 64].g, 2e-3f);           // -x
}

// Of a rotation by d, band l moves by at most l d: 5 * 0.1 degrees = 0.9 %. A tilt over ground also
// moves light over the horizon.
TEST(EnvironmentLighting, SmallTurnsMakeSmallSteps)
{
    AssetStore store;
    const AssetHandle day = store.addEnvironment(makeSky(64, 32, lopsided));
    const AssetHandle dusk = store.addEnvironment(makeSky(64, 32, evening));
    constexpr float kStep = glm::pi<float>() / 1800;
    const auto largestStep = [&](bool ground, vec3 axis, int first, int steps) {
        EnvironmentLighting lighting(store, ground);
        LightSh before{};
        double largest = 0;
        for (int i = 0; i <= steps; ++i) {
            const auto angle = static_cast<float>(first + i) * kStep;
            const float fade = 0.5f + 0.5f * std::cos(angle);
            lighting.set(std::vector<EnvironmentLight>{{day, fade, turnAbout(axis, angle)},
                                                       {dusk, 1 - fade, turnAbout(axis, angle)}});
            if (i > 0)
                largest = std::max(largest, difference(lighting.light(), before));
            before = lighting.light();
        }
        return largest;
    };
    const double turning = largestStep(true, vec3(0, 1, 0), -5, 3620);
    const double tilting = largestStep(true, vec3(1, 0, 0.3f), -5, 25);
    const double free = largestStep(false, vec3(1, 1, 0.3f), -5, 400);
    EXPECT_LT(turning, 0.01);
    EXPECT_LT(tilting, 0.015);
    EXPECT_LT(free, 0.01);
    RecordProperty("turning", std::to_string(turning));
    RecordProperty("tilting", std::to_string(tilting));
    RecordProperty("free", std::to_string(free));
}

TEST(EnvironmentLighting, StepsOfReceiversAreAsSmall)
{
    const TestScene scene = makeTestScene();
    AssetStore store;
    const AssetHandle day = store.addEnvironment(makeSky(64, 32, lopsided));
    EnvironmentLighting lighting(store, false);
    std::vector<vec4> before;
    double mean = 0, largest = 0;
    for (int i = 0; i < 6; ++i) {
        lighting.set(std::vector<EnvironmentLight>{
            {day, 1, yaw(static_cast<float>(i) * glm::pi<float>() / 1800)}});
        const std::vector<vec4> now =
            shadeAll(Kernel::Exact, scene.data, frameConstants(scene.view, lighting.light()));
        for (std::size_t k = 0; k < before.size(); ++k)
            for (int c = 0; c < 3; ++c) {
                mean += now[k][c] / (3.0 * 5 * static_cast<double>(now.size()));
                largest =
                    std::max(largest, std::abs(static_cast<double>(now[k][c]) - before[k][c]));
            }
        before = now;
    }
    EXPECT_GT(mean, 0.05);
    EXPECT_LT(largest, 0.01 * mean);
    RecordProperty("largest", std::to_string(largest / mean));
}

TEST(EnvironmentLighting, AUniformSkyGivesTheAlbedoAtAnyRotation)
{
    const std::vector<MeshAsset> assets = {makeSphereAsset(0.4f, 12, false)};
    const MeshAsset* const meshes[] = {&assets[0]};
    const SceneData scene = buildSceneData(meshes, {{.material = {vec3(0.37f), 0, 0}}});
    AssetStore store;
    const AssetHandle white = store.addEnvironment(makeSky(32, 16, [](vec3) { return vec3(1); }));
    const AssetHandle small = store.addEnvironment(makeSky(2, 1, [](vec3) { return vec3(0.5f); }));
    for (const vec4 turn : kTurns)
        for (const Kernel kernel : {Kernel::Literal, Kernel::Exact}) {
            const LightSh light = lightOf(store, {{white, 0.6f, turn}, {small, 0.8f, kTurns[1]}});
            const std::vector<vec4> radiance = shadeAll(kernel, scene, frameConstants({}, light));
            for (std::size_t i = 0; i < scene.vertexCount; ++i)
                ASSERT_NEAR(radiance[i].x, 0.37f, 0.005f * 0.37f) << kernelName(kernel);
        }
}

TEST(EnvironmentLighting, TheStrongestTwoAreDrawnAndAllGiveLight)
{
    AssetStore store;
    std::vector<EnvironmentLight> lights;
    for (const float radiance : {1.0f, 4.0f, 2.0f}) // times 1, 0.2, 1: the second is the weakest
        lights.push_back(
            {store.addEnvironment(makeSky(8, 4, [&](vec3) { return vec3(radiance); }))});
    lights[1].intensity = 0.2f;
    lights[2].rotation = kTurns[0];
    EnvironmentLighting lighting(store, false);
    lighting.set(lights);
    EXPECT_NEAR(lighting.light()[0].g, (1 + 0.8f + 2) * kSqrt4Pi, 1e-4f);
    ASSERT_EQ(lighting.background().size(), 2u);
    EXPECT_EQ(lighting.background()[0].map, &store.environment(lights[0].asset));
    EXPECT_EQ(lighting.background()[1].map, &store.environment(lights[2].asset));
    EXPECT_EQ(lighting.background()[1].rotation, kTurns[0]);
}

TEST(EnvironmentLighting, LobesFollowTheLights)
{
    AssetStore store;
    const AssetHandle day = store.addEnvironment(makeSky(64, 32, lopsided));
    const AssetHandle dusk = store.addEnvironment(makeSky(64, 32, evening));
    const vec3 up = normalize(vec3(1, 2, 0.5f)), down(0, -1, 0);
    for (const bool ground : {false, true}) {
        EnvironmentLighting lighting(store, ground);
        const auto at = [&](std::vector<EnvironmentLight> lights, vec3 direction) {
            lighting.set(lights);
            return filteredSky(lighting.lobes(), direction, 256);
        };
        const vec3 first = at({{day, 1}}, up), second = at({{dusk, 1}}, up);
        EXPECT_GT(length(first - second), 1);
        EXPECT_LT(length(at({{day, 0.5f}, {dusk, 2}}, up) - (0.5f * first + 2.0f * second)), 1e-4);
        EXPECT_EQ(at({{day, 1}}, up), first); // known by now
        EXPECT_EQ(at({{day, 0}}, up), vec3(0));
        EXPECT_EQ(at({{day, 1}}, down) == vec3(0), ground);
    }
}

} // namespace
} // namespace penumbra
