// Beams: what they take of a sky, and where their maps lie. Their shadows:
// sky_beams_frame_test.cpp.
#include "systems/beam_maps.h"
#include "systems/environment_lighting.h"

#include "tests/systems/environment/test_skies.h"
#include "tests/systems/shadow_fields/test_scene.h"

#include <gtest/gtest.h>
#include <numbers>

namespace penumbra {
namespace {

const vec3 kLamp = normalize(vec3(0.8f, 0.75f, 0.35f));

Environment lampSky()
{
    return makeSky(256, 128, [](vec3 d) {
        return vec3(0.05f) + (dot(d, kLamp) > std::cos(0.1f) ? vec3(60, 40, 20) : vec3(0));
    });
}

// Of all directions: the integral of radiance max(0, n.w), or of radiance.
glm::dvec3 integrate(const Environment& map, const vec3* normal)
{
    glm::dvec3 sum(0);
    for (std::uint32_t y = 0; y < map.mapHeight; ++y)
        for (std::uint32_t x = 0; x < map.mapWidth; ++x) {
            const vec3 d =
                equirectDirection((vec2(x, y) + 0.5f) / vec2(map.mapWidth, map.mapHeight));
            const double cosine = normal != nullptr ? std::max(dot(*normal, d), 0.0f) : 1;
            sum += cosine * equirectPixelSolidAngle(map.mapWidth, map.mapHeight, y) *
                   glm::dvec3(map.map[y * map.mapWidth + x]);
        }
    return sum;
}

TEST(SkyBeams, AndTheRestAreTheSky)
{
    const Environment sky = makeSky(128, 64, lopsided);
    const SkySplit split = splitSky(sky, 32);
    const float limit = kBrightSky * sky.statistics.meanLuminance;
    float brightest = 0;
    for (std::size_t i = 0; i < sky.map.size(); ++i) {
        ASSERT_LT(length(split.rest.map[i] + split.bright.map[i] - sky.map[i]),
                  1e-3f * length(sky.map[i]));
        ASSERT_LT(luminance(split.rest.map[i]), 1.001f * limit);
        brightest = std::max(brightest, luminance(split.bright.map[i]));
    }
    EXPECT_GT(brightest, limit);
    ASSERT_EQ(split.beams.size(), 32u);
    const double power = glm::length(integrate(split.bright, nullptr));
    for (const vec3 normal : {vec3(0, 1, 0), kLamp, normalize(vec3(-1, 0.2f, 2)), vec3(0, 0, -1)}) {
        glm::dvec3 sum(0);
        for (const SkyBeam& beam : split.beams)
            sum += glm::dvec3(std::max(dot(normal, beam.direction), 0.0f)) *
                   glm::dvec3(beam.irradiance);
        const glm::dvec3 wanted = integrate(split.bright, &normal);
        EXPECT_LT(glm::length(sum - wanted), 0.005 * power);
    }
}

TEST(SkyBeams, OneLampIsOneBeam)
{
    const Environment sky = lampSky();
    const SkySplit split = splitSky(sky, 1);
    ASSERT_EQ(split.beams.size(), 1u);
    const SkyBeam& beam = split.beams.front();
    EXPECT_GT(dot(beam.direction, kLamp), std::cos(0.01f));
    EXPECT_NEAR(beam.halfAngle, 0.1f, 0.01f);
    const glm::dvec3 power = integrate(split.bright, nullptr);
    EXPECT_LT(glm::length(glm::dvec3(beam.irradiance) - power), 5e-3 * glm::length(power));
    EXPECT_NEAR(beam.irradiance.r / beam.irradiance.b, 3, 0.05);
}

TEST(SkyBeams, AreNarrowerWhereThereAreMore)
{
    float before = 1;
    for (const std::uint32_t count : {1u, 4u, 16u, kMaxBeams}) {
        const SkySplit split = splitSky(lampSky(), count);
        ASSERT_EQ(split.beams.size(), count);
        float widest = 0;
        for (const SkyBeam& beam : split.beams)
            widest = std::max(widest, beam.halfAngle);
        EXPECT_LT(widest, 0.8f * before);
        before = widest;
    }
}

TEST(SkyBeams, NoneWhereNothingIsBright)
{
    const Environment uniform = makeSky(64, 32, [](vec3) { return vec3(0.7f); });
    EXPECT_TRUE(splitSky(uniform, 32).beams.empty());
    EXPECT_TRUE(splitSky(makeSky(64, 32, [](vec3) { return vec3(0); }), 32).beams.empty());
    const SkySplit none = splitSky(lampSky(), 0);
    EXPECT_TRUE(none.beams.empty());
    EXPECT_EQ(none.rest.sh6, lampSky().sh6);
    EXPECT_TRUE(none.bright.map.empty());
    // Two lamps that face each other have no direction in common.
    const Environment both =
        makeSky(64, 32, [](vec3 d) { return vec3(std::abs(d.y) > 0.99f ? 9 : 0); });
    const SkySplit one = splitSky(both, 1);
    ASSERT_EQ(one.beams.size(), 1u);
    EXPECT_NEAR(length(one.beams[0].direction), 1, 1e-5);
    // A single pixel cannot be cut.
    const Environment pixel =
        makeSky(8, 4, [n = 0](vec3) mutable { return vec3(n++ == 5 ? 9 : 0); });
    EXPECT_EQ(splitSky(pixel, 32).beams.size(), 1u);
}

TEST(SkyBeams, TurnAndFadeWithTheirSky)
{
    AssetStore store;
    const AssetHandle lamp = store.addEnvironment(lampSky());
    const AssetHandle day = store.addEnvironment(makeSky(64, 32, lopsided));
    EnvironmentLighting lighting(store, false, 8);
    lighting.set(std::vector<EnvironmentLight>{{lamp, 1, vec4(0, 0, 0, 1)}});
    const std::vector<SkyBeam> still = lighting.beams();
    ASSERT_EQ(still.size(), 8u);
    lighting.set(std::vector<EnvironmentLight>{{lamp, 0.25f, yaw(1.3f)}});
    const mat3 turn = rotationMatrix(yaw(1.3f));
    ASSERT_EQ(lighting.beams().size(), still.size());
    for (std::size_t k = 0; k < still.size(); ++k) {
        EXPECT_LT(length(lighting.beams()[k].direction - turn * still[k].direction), 1e-5f);
        EXPECT_LT(length(lighting.beams()[k].irradiance - 0.25f * still[k].irradiance), 1e-5f);
    }
    // Two share them, the dark one too, so nothing jumps where one fades in.
    lighting.set(std::vector<EnvironmentLight>{{lamp, 1, yaw(0)}, {day, 0, yaw(0)}});
    EXPECT_EQ(lighting.beams().size(), 4u);
    lighting.set(std::vector<EnvironmentLight>{{lamp, 1, yaw(0)}, {day, 0.5f, yaw(0)}});
    EXPECT_EQ(lighting.beams().size(), 8u);
    // What the beams take is not in the SH: band 0 says how much.
    EnvironmentLighting whole(store, false);
    whole.set(std::vector<EnvironmentLight>{{lamp, 1, yaw(0)}});
    lighting.set(std::vector<EnvironmentLight>{{lamp, 1, yaw(0)}});
    float sum = lighting.light()[0].g * std::sqrt(4 * std::numbers::pi_v<float>);
    for (const SkyBeam& beam : lighting.beams())
        sum += beam.irradiance.g;
    EXPECT_NEAR(sum / (whole.light()[0].g * std::sqrt(4 * std::numbers::pi_v<float>)), 1, 1e-3);
}

vec3 inMap(const GpuBeam& beam, vec3 p)
{
    const vec4 h(p, 1);
    return {dot(beam.u, h), dot(beam.v, h), dot(beam.depth, h)};
}

TEST(BeamMaps, HoldEveryOccluderAndAnEmptyEdge)
{
    TestScene test = makeTestScene();
    std::vector<SkyBeam> beams;
    for (const vec3 d : {vec3(0, 1, 0), normalize(vec3(1, 0.1f, 0)), normalize(vec3(-1, 2, 3))})
        beams.push_back({d, vec3(1), 0.1f});
    FrameConstants frame{};
    placeBeams(test.data, beams, frame);
    ASSERT_EQ(frame.beamCount, 3u);
    constexpr float kTexel = 1.0f / static_cast<float>(kBeamMapSide);
    int corners = 0;
    for (std::uint32_t k = 0; k < frame.beamCount; ++k) {
        const GpuBeam& beam = frame.beams[k];
        for (const SceneInstance& instance : test.data.instances) {
            if (!instance.occluder)
                continue;
            for (const vec3& p : test.assets[instance.mesh].positions) {
                const vec3 at =
                    inMap(beam, instance.position + instance.scale * rotate(instance.rotation, p));
                ASSERT_GT(at.x, kTexel);
                ASSERT_LT(at.x, 1 - kTexel);
                ASSERT_GT(at.y, kTexel);
                ASSERT_LT(at.y, 1 - kTexel);
                ASSERT_GE(at.z, 0);
                ASSERT_LE(at.z, 1);
                ++corners;
            }
        }
        // Towards the light is up, by metres.
        const vec3 up = vec3(beam.direction) * beam.irradiance.w;
        EXPECT_NEAR(inMap(beam, up).z - inMap(beam, vec3(0)).z, -1, 1e-4);
    }
    EXPECT_GT(corners, 1000);
}

// A window that follows a moving occluder goes by whole texels: the others keep their places in
// them, so their shadows do not creep.
TEST(BeamMaps, MoveByWholeTexels)
{
    TestScene test = makeTestScene();
    const std::vector<SkyBeam> beams = {{normalize(vec3(1, 2, 0.5f)), vec3(1), 0.1f}};
    // The one that the window's edge follows.
    std::size_t moving = 0;
    for (std::size_t i = 0; i < test.data.instances.size(); ++i)
        if (test.data.instances[i].occluder &&
            (!test.data.instances[moving].occluder ||
             test.data.instances[i].position.x > test.data.instances[moving].position.x))
            moving = i;
    FrameConstants frame{};
    placeBeams(test.data, beams, frame);
    const GpuBeam first = frame.beams[0];
    int steps = 0;
    float farthest = 0;
    for (int i = 1; i <= 200; ++i) {
        test.data.instances[moving].position.x += 1e-3f;
        placeBeams(test.data, beams, frame);
        const GpuBeam& now = frame.beams[0];
        if (now.size.x != first.size.x || now.size.y != first.size.y)
            break; // four times per octave
        for (const float moved : {now.u.w - first.u.w, now.v.w - first.v.w}) {
            const float texels = moved * static_cast<float>(kBeamMapSide);
            ASSERT_NEAR(texels, std::round(texels), 1e-2f);
            farthest = std::max(farthest, std::abs(texels));
        }
        ++steps;
    }
    EXPECT_GT(steps, 20);
    EXPECT_GE(farthest, 4); // it did move
}

TEST(BeamMaps, RunsOfOneMeshAreOneDraw)
{
    SceneData data;
    const auto add = [&](std::uint32_t mesh, std::optional<std::uint32_t> occluder) {
        data.instances.push_back({.mesh = mesh, .occluder = occluder});
    };
    add(0, {});
    add(1, 1);
    add(1, 1);
    add(3, 1); // blocks as another asset
    add(1, {});
    add(1, 1);
    add(2, 2);
    const std::vector<CasterRun> runs = casterRuns(data);
    ASSERT_EQ(runs.size(), 3u);
    const std::uint32_t wanted[][3] = {{1, 1, 3}, {1, 5, 1}, {2, 6, 1}};
    for (std::size_t i = 0; i < runs.size(); ++i) {
        EXPECT_EQ(runs[i].mesh, wanted[i][0]);
        EXPECT_EQ(runs[i].firstInstance, wanted[i][1]);
        EXPECT_EQ(runs[i].instanceCount, wanted[i][2]);
    }
}

// On a tilted plane, the depth that a receiver expects beside it is that of the plane.
TEST(BeamMaps, ExpectThePlaneOfAReceiver)
{
    const TestScene test = makeTestScene();
    FrameConstants frame{};
    placeBeams(test.data, std::vector<SkyBeam>{{normalize(vec3(1, 2, 0.5f)), vec3(1), 0.1f}},
               frame);
    GpuBeam beam = frame.beams[0];
    beam.size.z = 0; // no offset along the normal
    const vec3 normal = normalize(vec3(0.3f, 1, -0.4f)), position(0.1f, 0.2f, 0.3f);
    const BeamPoint at = beamPoint(beam, position, normal);
    const vec3 along = 0.2f * normalize(cross(normal, vec3(0, 0, 1)));
    for (const vec3 step : {along, cross(normal, along)}) {
        const vec3 moved = inMap(beam, position + step);
        EXPECT_NEAR(at.depth + dot(at.slope, vec2(moved) - at.uv), moved.z, 1e-5);
    }
}

TEST(BeamMaps, TapsLieOnTheDisc)
{
    for (std::uint32_t beam = 0; beam < kMaxBeams; ++beam) {
        EXPECT_EQ(beamTap(0, beam), vec2(0));
        for (std::uint32_t tap = 1; tap < kBeamTaps; ++tap) {
            EXPECT_GT(length(beamTap(tap, beam)), 0.3f);
            EXPECT_LT(length(beamTap(tap, beam)), 1);
        }
    }
    GpuBeam beam{};
    beam.direction.w = 0.1f;
    beam.size = vec4(4, 2, 0, 0);
    EXPECT_EQ(beamRadius(beam, -1), vec2(1.0f / static_cast<float>(kBeamMapSide)));
    EXPECT_LT(length(beamRadius(beam, 1) - vec2(0.025f, 0.05f)), 1e-6f);
    EXPECT_EQ(beamRadius(beam, 100), vec2(kBeamWidest));
}

// The coarsest level that is near enough.
TEST(BeamMaps, AreDrawnFromALevelOfDetail)
{
    MeshAsset mesh = makeSphereAsset(0.5f, 32);
    const auto level = [&](float error) {
        MeshLod lod;
        static_cast<MeshGeometry&>(lod) = makeSphereAsset(0.5f, error > 0.01f ? 4 : 16, false);
        lod.error = error;
        return lod;
    };
    mesh.lods = {level(1e-4f), level(0.1f)};
    updateDerived(mesh);
    const MeshAsset* const meshes[] = {&mesh};
    const SceneData data = buildSceneData(meshes, {{.mesh = 0, .occluder = 0}});
    EXPECT_EQ(data.meshes[0].casterIndexCount, mesh.lods[0].indices.size());
    EXPECT_EQ(data.meshes[0].casterError, 1e-4f);
    mesh.lods.clear();
    const SceneData full = buildSceneData(meshes, {{.mesh = 0, .occluder = 0}});
    EXPECT_EQ(full.meshes[0].casterIndexCount, mesh.indices.size());
    EXPECT_EQ(full.meshes[0].casterError, 0);
}

} // namespace
} // namespace penumbra
