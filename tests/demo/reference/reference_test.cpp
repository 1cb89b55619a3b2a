// The reference against closed forms, and its promises: equal bits at any thread count, rotation
// with the scene.
#include "demo/reference/reference.h"

#include "tests/demo/reference/reference_scenes.h"

#include <cstdio>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

namespace penumbra {

namespace {

constexpr float kPi = std::numbers::pi_v<float>;

const MeshMaterial kMatte{vec3(0.5f, 0.25f, 0.75f), 0, 0};
const MeshMaterial kGlossy{vec3(1), 0.6f, 20};
const std::vector<MeshMaterial> kMaterials = {kMatte, kGlossy};

ReferenceScene buildScene(std::span<const ReferenceInstance> instances)
{
    Result<ReferenceScene> scene = ReferenceScene::build(instances, kMaterials);
    EXPECT_TRUE(scene) << scene.error().message;
    return std::move(*scene);
}

void expectRelative(vec3 value, vec3 wanted, float tolerance)
{
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(value[c] / wanted[c], 1.0f, tolerance) << c;
}

// 40 receivers over the unit sphere, each with another normal and eye.
std::vector<ReferenceReceiver> receiversOnSphere(const mat3& turn, std::uint32_t material)
{
    std::vector<ReferenceReceiver> receivers;
    for (int i = 0; i < 40; ++i) {
        const vec3 n = turn * equirectDirection({(static_cast<float>(i % 8) + 0.3f) / 8,
                                                 (static_cast<float>(i / 8) + 0.4f) / 5});
        const vec3 eye = turn * vec3(3, 4, 5);
        receivers.push_back({n, n, normalize(eye - n), material, kNoInstance});
    }
    return receivers;
}

TEST(Reference, UniformSkyGivesTheAlbedo)
{
    const ReferenceScene scene = buildScene({});
    const ReferenceLight sky = ReferenceLight::fromMap(test::uniformSky(vec3(1)));
    const ReferenceRadiance truth = shadeReference(scene, sky, receiversOnSphere(mat3(1), 0));
    for (std::size_t i = 0; i < truth.shadowed.size(); ++i) {
        expectRelative(truth.unshadowed[i], kMatte.albedo, 0.005f);
        EXPECT_EQ(truth.shadowed[i], truth.unshadowed[i]); // nothing is in the way
    }
}

// From the point below its centre at distance h, a sphere of radius R hides the share (R / h)^2 of
// the cosine-weighted sky: the projected solid angle pi sin^2 of its cap.
TEST(Reference, SphereAboveAPlaneBlocksItsFormFactor)
{
    const MeshAsset sphere = test::makeSphere(128), plane = test::makePlane();
    for (const float h : {1.5f, 2.0f, 4.0f}) {
        const std::vector<ReferenceInstance> instances = {
            {&plane, test::placed({0, 0, 0}, 50), 0},
            {&sphere, test::placed({0, 0.8f * h, 0}, 0.8f), 0}};
        const ReferenceScene scene = buildScene(instances);
        const ReferenceLight sky = ReferenceLight::fromMap(test::uniformSky(vec3(1)));
        const std::vector<ReferenceReceiver> receivers(
            16, ReferenceReceiver{{0, 0, 0}, {0, 1, 0}, {0, 1, 0}, 0, 0});
        const ReferenceRadiance truth = shadeReference(scene, sky, receivers, {.samples = 4096});
        for (const vec3 c : truth.shadowed)
            expectRelative(c, kMatte.albedo * (1.0f - 1.0f / (h * h)), 0.01f);
    }
}

// Along the normal f integrates to 1 for any gloss.
TEST(Reference, GlossConservesEnergyAlongTheNormal)
{
    const ReferenceScene scene = buildScene({});
    const ReferenceLight sky = ReferenceLight::fromMap(test::uniformSky(vec3(3)));
    const std::vector<ReferenceReceiver> receivers(
        16, ReferenceReceiver{{}, {0, 1, 0}, {0, 1, 0}, 1, kNoInstance});
    for (const vec3 c : shadeReference(scene, sky, receivers).unshadowed)
        expectRelative(c, vec3(3), 0.005f);
}

// A map of one lit pixel is a small lamp: radiance = albedo L solidAngle f(w).
TEST(Reference, OneLitPixelIsALamp)
{
    std::vector<vec3> map(256 * 128, vec3(0));
    map[30 * 256 + 100] = vec3(1000);
    const Environment sky = makeEnvironment(256, 128, std::move(map));
    const vec3 lamp = equirectDirection({100.5f / 256, 30.5f / 128});
    const auto power = static_cast<float>(1000 * equirectPixelSolidAngle(256, 128, 30));
    const vec3 n = normalize(vec3(0.3f, 1, 0.2f));
    const vec3 eye =
        normalize(2 * dot(n, lamp) * n - lamp + vec3(0.1f, 0, 0)); // near the highlight
    const float mirrored = dot(2 * dot(n, eye) * n - eye, lamp);
    const float f = dot(n, lamp) * (0.4f / kPi + 0.6f * 22 / (2 * kPi) * std::pow(mirrored, 20.0f));
    const ReferenceScene scene = buildScene({});
    const std::vector<ReferenceReceiver> receivers(8,
                                                   ReferenceReceiver{{}, n, eye, 1, kNoInstance});
    for (const vec3 c : shadeReference(scene, ReferenceLight::fromMap(sky), receivers).unshadowed)
        expectRelative(c, vec3(power * f), 0.005f);
}

// Irradiance from SH: order 3 carries it within 1 % (Ramamoorthi and Hanrahan 2001), so the map and
// its SH agree there. And the SH light is not clamped: a band alone integrates with the cosine to
// its factor, sign and all.
TEST(Reference, Sh4LightFollowsTheCosineFactors)
{
    const ReferenceScene scene = buildScene({});
    for (const float sign : {1.0f, -1.0f}) {
        std::array<vec3, 16> sh4{};
        sh4[0] = vec3(0.2f);
        sh4[1] = vec3(sign); // ~ y
        const ReferenceLight light = ReferenceLight::fromSh4(sh4, mat3(1), 2.0f);
        const std::vector<ReferenceReceiver> receivers(
            4, ReferenceReceiver{{}, {0, 1, 0}, {0, 1, 0}, 0, kNoInstance});
        const float wanted = 2.0f * (0.2f * 0.282094792f + sign * 0.488602512f * 2.0f / 3.0f);
        for (const vec3 c : shadeReference(scene, light, receivers).unshadowed)
            expectRelative(c, kMatte.albedo * wanted, 0.01f);
    }
}

TEST(Reference, TurningEverythingChangesNothing)
{
    const MeshAsset sphere = test::makeSphere(48);
    const Environment environment = test::lampSky();
    const mat3 turn(glm::mat3_cast(glm::angleAxis(0.9f, normalize(vec3(2, -1, 3)))));
    std::vector<ReferenceRadiance> results;
    for (const mat3& m : {mat3(1), turn}) {
        const std::vector<ReferenceInstance> instances = {
            {&sphere, mat4(m) * test::placed({1.2f, 1.5f, 0.3f}, 0.6f), 0}};
        results.push_back(shadeReference(buildScene(instances),
                                         ReferenceLight::fromMap(environment, m),
                                         receiversOnSphere(m, 0), {.samples = 16384}));
    }
    const RadianceErrors errors =
        compareRadiance(results[1].shadowed, results[0].shadowed, results[0].unshadowed);
    EXPECT_LT(errors.rmseRelative, 2e-3);
    EXPECT_GT(errors.meanUnshadowed, 0.1);
    // The sphere does hide something, so that this is not a test of an empty scene.
    EXPECT_GT(compareRadiance(results[0].shadowed, results[0].unshadowed, results[0].unshadowed)
                  .rmseRelative,
              0.05);
}

TEST(Reference, AnyThreadCountGivesTheSameBits)
{
    const MeshAsset sphere = test::makeSphere(64);
    const Environment environment = test::lampSky();
    std::vector<ReferenceRadiance> results;
    for (const int threads : {1, 2, 7}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                        static_cast<std::size_t>(threads));
        tbb::task_arena arena(threads);
        arena.execute([&] {
            const std::vector<ReferenceInstance> instances = {
                {&sphere, test::placed({1.2f, 1.5f, 0.3f}, 0.6f), 0},
                {&sphere, test::placed({-1, 2, 1}, 0.9f), 0}};
            results.push_back(shadeReference(buildScene(instances),
                                             ReferenceLight::fromMap(environment),
                                             receiversOnSphere(mat3(1), 1), {.samples = 256}));
        });
    }
    for (const ReferenceRadiance& r : results) {
        EXPECT_EQ(r.shadowed, results[0].shadowed);
        EXPECT_EQ(r.unshadowed, results[0].unshadowed);
        EXPECT_EQ(r.rays, results[0].rays);
    }
}

// A receiver on a closed convex mesh sees the whole hemisphere: the offset keeps rays off the
// mesh's own triangles.
TEST(Reference, VerticesDoNotShadowThemselves)
{
    const MeshAsset sphere = test::makeSphere(32);
    const std::vector<ReferenceInstance> instances = {
        {&sphere, test::placed({3, -2, 7}, 40.0f), 0}};
    const ReferenceScene scene = buildScene(instances);
    std::vector<ReferenceReceiver> receivers;
    for (const vec3& p : sphere.positions)
        receivers.push_back({vec3(3, -2, 7) + 40.0f * p, p, p, 0, 0});
    const ReferenceRadiance truth =
        shadeReference(scene, ReferenceLight::fromMap(test::uniformSky(vec3(1))), receivers);
    const RadianceErrors errors =
        compareRadiance(truth.shadowed, truth.unshadowed, truth.unshadowed);
    EXPECT_LT(errors.maxAbs, 1e-3 * errors.meanUnshadowed);
}

// Noise at the default sample count, against 64 times as many, under a lamp in noise, which is
// harder than a real map: printed, and bounded so that "truth" stays truth.
TEST(Reference, NoiseIsSmallAtTheDefaultSampleCount)
{
    const MeshAsset sphere = test::makeSphere(64);
    const std::vector<ReferenceInstance> instances = {
        {&sphere, test::placed({1.2f, 1.5f, 0.3f}, 0.6f), 0},
        {&sphere, test::placed({-1, 2, 1}, 0.9f), 0}};
    const ReferenceScene scene = buildScene(instances);
    const Environment environment = test::lampSky(256, 128);
    for (const std::uint32_t material : {0u, 1u}) {
        const auto receivers = receiversOnSphere(mat3(1), material);
        const ReferenceLight light = ReferenceLight::fromMap(environment);
        const ReferenceRadiance truth =
            shadeReference(scene, light, receivers, {.samples = 65536, .seed = 9});
        const ReferenceRadiance usual = shadeReference(scene, light, receivers);
        const RadianceErrors errors =
            compareRadiance(usual.shadowed, truth.shadowed, truth.unshadowed);
        std::printf("material %u: noise %.5f of the mean unshadowed radiance, bias %.5f; %.1f "
                    "million rays/s\n",
                    material, errors.rmseRelative, errors.bias / errors.meanUnshadowed,
                    static_cast<double>(truth.rays) / truth.seconds * 1e-6);
        EXPECT_LT(errors.rmseRelative, 0.03);
        EXPECT_LT(std::abs(errors.bias), 0.01 * errors.meanUnshadowed);
    }
}

TEST(RadianceErrors, FollowTheirDefinition)
{
    const std::vector<vec3> truth = {vec3(1), vec3(2, 0, 1)}, unshadowed = {vec3(2), vec3(4)};
    const std::vector<vec3> test = {vec3(1, 1, 4), vec3(2, 0, 0)};
    const RadianceErrors errors = compareRadiance(test, truth, unshadowed);
    EXPECT_DOUBLE_EQ(errors.meanUnshadowed, 3.0);
    EXPECT_DOUBLE_EQ(errors.rmse, std::sqrt(10.0 / 6.0));
    EXPECT_DOUBLE_EQ(errors.rmseRelative, std::sqrt(10.0 / 6.0) / 3.0);
    EXPECT_DOUBLE_EQ(errors.bias, 2.0 / 6.0);
    EXPECT_DOUBLE_EQ(errors.maxAbs, 3.0);
    EXPECT_FLOAT_EQ(errorPerReceiver(test, truth)[0], std::sqrt(3.0f));
}

} // namespace

} // namespace penumbra
