// Round lights against closed forms and against the general reference, and what order 4 makes of
// them.
#include "demo/reference/sh4_light.h"
#include "shaders/shared/transfer.h"
#include "tests/demo/reference/reference_scenes.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

namespace penumbra {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
const std::vector<MeshMaterial> kMatte = {{vec3(1), 0, 0}};
const ReferenceReceiver kUp{vec3(0), vec3(0, 1, 0), vec3(0, 1, 0), 0, kNoInstance};

ReferenceScene sceneOf(std::span<const ReferenceInstance> instances)
{
    Result<ReferenceScene> scene = ReferenceScene::build(instances, kMatte);
    EXPECT_TRUE(scene);
    return std::move(*scene);
}

// Unit vector at the angle from +Y towards +X.
vec3 tilted(float degrees)
{
    return {std::sin(degrees * kPi / 180), std::cos(degrees * kPi / 180), 0};
}

float sine(float degrees)
{
    return std::sin(degrees * kPi / 180);
}

// Sums f over the directions of a fine grid of the sphere.
template <class F>
double integrate(const F& f)
{
    constexpr std::uint32_t kWidth = 1024, kHeight = 512;
    double sum = 0;
    for (std::uint32_t y = 0; y < kHeight; ++y)
        for (std::uint32_t x = 0; x < kWidth; ++x)
            sum += f(equirectDirection((vec2(x, y) + 0.5f) / vec2(kWidth, kHeight))) *
                   equirectPixelSolidAngle(kWidth, kHeight, y);
    return sum;
}

TEST(RoundLight, IrradianceIsTheIntegralOfTheCosine)
{
    for (const float halfAngle : {10.0f, 40.0f, 75.0f, 89.9f})
        for (const float tilt : {0.0f, 30.0f, 60.0f, 85.0f, 100.0f, 140.0f}) {
            const RoundView view{tilted(tilt), sine(halfAngle)};
            const float rim = std::cos(halfAngle * kPi / 180);
            const double wanted = integrate(
                [&](vec3 w) { return dot(w, view.axis) >= rim ? std::max(0.0f, w.y) : 0.0f; });
            EXPECT_NEAR(roundIrradiance(view, vec3(0, 1, 0)), wanted, 0.006)
                << halfAngle << ' ' << tilt;
        }
}

// Without occluders the answer has no noise, however few the rays.
TEST(RoundLight, FullLightIsExact)
{
    const ReferenceScene scene = sceneOf({});
    for (const float halfAngle : {5.0f, 30.0f}) {
        const RoundLight cap = RoundLight::cap(tilted(40), sine(halfAngle), 2);
        const ReferenceRadiance got = shadeRound(scene, cap, std::span(&kUp, 1), {.samples = 4});
        EXPECT_NEAR(got.shadowed[0].x, 2 / kPi * roundIrradiance(cap.seenFrom(vec3(0)), kUp.normal),
                    1e-5f);
        EXPECT_EQ(got.shadowed[0], got.unshadowed[0]);
    }
}

// A ball amid the disc takes away its own form factor; behind the lamp it takes nothing.
TEST(RoundLight, ABallInTheWayDimsIt)
{
    const MeshAsset ball = test::makeSphere(48);
    for (const float halfAngle : {40.0f, 89.9f}) { // even rays, and such that follow the cosine
        const RoundLight cap = RoundLight::cap(vec3(0, 1, 0), sine(halfAngle), 1);
        const ReferenceInstance before{&ball, test::placed(vec3(0, 3, 0), 1), 0};
        const float wanted = sine(halfAngle) * sine(halfAngle) - 1.0f / 9;
        EXPECT_NEAR(
            shadeRound(sceneOf(std::span(&before, 1)), cap, std::span(&kUp, 1), {.samples = 4096})
                .shadowed[0]
                .x,
            wanted, 0.004f);
    }
    const RoundLight lamp = RoundLight::sphere(vec3(0, 5, 0), 2, 1);
    const ReferenceInstance behind{&ball, test::placed(vec3(0, 9, 0), 1.5f), 0};
    EXPECT_NEAR(
        shadeRound(sceneOf(std::span(&behind, 1)), lamp, std::span(&kUp, 1), {.samples = 256})
            .shadowed[0]
            .x,
        4.0f / 25, 1e-5f);
}

// The sphere as a mesh that shines, sampled by area: the same light by other means.
TEST(RoundLight, SphereEqualsItsMesh)
{
    MeshAsset mesh = test::makeSphere(48);
    mesh.materials.resize(1);
    mesh.materials[0].emissive = vec3(3);
    // Counter-clockwise from outside, which is the side that shines.
    const auto corner = [&](std::size_t i) { return mesh.positions[mesh.indices[i]]; };
    const std::size_t middle = mesh.indices.size() / 6 * 3; // no triangle of the poles
    if (dot(cross(corner(middle + 1) - corner(middle), corner(middle + 2) - corner(middle)),
            corner(middle)) < 0)
        std::reverse(mesh.indices.begin(), mesh.indices.end());
    mesh.submeshes = {{0, static_cast<std::uint32_t>(mesh.indices.size()), 0,
                       static_cast<std::uint32_t>(mesh.positions.size()), 0}};
    const MeshAsset ball = test::makeSphere(24);
    const ReferenceInstance instances[] = {{&mesh, test::placed(vec3(1, 4, 0), 1.2f), 0},
                                           {&ball, test::placed(vec3(0.2f, 1.5f, 0), 0.3f), 0}};
    const ReferenceScene all = sceneOf(instances), blocker = sceneOf(std::span(instances).last(1));
    const Result<AreaLight> area = AreaLight::make(0, instances[0], vec3(1));
    ASSERT_TRUE(area);
    const ReferenceLight dark = ReferenceLight::fromMap(test::uniformSky(vec3(0)));
    const vec3 wanted =
        shadeReference(all, {dark, std::span(&*area, 1)}, std::span(&kUp, 1), {.samples = 16384})
            .shadowed[0];
    const RoundLight lamp = RoundLight::sphere(vec3(1, 4, 0), 1.2f, 3);
    const ReferenceRadiance got = shadeRound(blocker, lamp, std::span(&kUp, 1), {.samples = 4096});
    EXPECT_LT(got.shadowed[0].x, 0.9f * got.unshadowed[0].x); // the ball is in the way
    EXPECT_NEAR(got.shadowed[0].x / wanted.x, 1, 0.02f);

    const Sh4Light round = sh4Of(lamp, vec3(0)), sampled = sh4Of(*area, vec3(0), 4096);
    for (std::size_t k = 0; k < 16; ++k)
        EXPECT_NEAR(sampled.radiance[k].x, round.radiance[k].x, 0.02f * round.radiance[0].x) << k;
    EXPECT_NEAR(sampled.reach, round.reach, 0.1f);
    EXPECT_LT(sampled.reach, round.reach);
}

// Receivers in and beside the penumbra of a ball.
std::vector<ReferenceReceiver> lineOfReceivers()
{
    std::vector<ReferenceReceiver> receivers;
    for (int i = 0; i < 256; ++i)
        receivers.push_back({vec3(-2 + static_cast<float>(i) / 64, 0, 0.1f), vec3(0, 1, 0),
                             vec3(0, 1, 0), 0, kNoInstance});
    return receivers;
}

TEST(RoundLight, ErrorFallsAtLeastAsTheRootOfTheRays)
{
    const MeshAsset ball = test::makeSphere(24);
    const ReferenceInstance instance{&ball, test::placed(vec3(0, 1, 0), 0.4f), 0};
    const ReferenceScene scene = sceneOf(std::span(&instance, 1));
    const RoundLight cap = RoundLight::cap(tilted(30), sine(25), 1);
    const std::vector<ReferenceReceiver> receivers = lineOfReceivers();
    const ReferenceRadiance truth =
        shadeRound(scene, cap, receivers, {.samples = 65536, .seed = 9});
    double before = 0;
    for (const std::uint32_t rays : {4u, 16u, 64u, 256u}) {
        const ReferenceRadiance got = shadeRound(scene, cap, receivers, {.samples = rays});
        const double rmse =
            compareRadiance(got.shadowed, truth.shadowed, truth.unshadowed).rmseRelative;
        if (before > 0) {
            EXPECT_LT(rmse, before / 2 * 1.1) << rays;
        }
        EXPECT_GT(rmse, 0);
        before = rmse;
    }
}

TEST(RoundLight, SameBitsOnOneThread)
{
    const MeshAsset ball = test::makeSphere(12);
    const ReferenceInstance instance{&ball, test::placed(vec3(0, 1, 0), 0.4f), 0};
    const ReferenceScene scene = sceneOf(std::span(&instance, 1));
    const RoundLight cap = RoundLight::cap(tilted(30), sine(25), 1);
    const auto shade = [&] {
        return shadeRound(scene, cap, lineOfReceivers(), {.samples = 64}).shadowed;
    };
    const std::vector<vec3> many = shade();
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(many, shade());
}

TEST(Sh4Light, ZonalCoefficientsAreTheProjection)
{
    for (const float halfAngle : {8.0f, 35.0f, 70.0f}) {
        const RoundLight cap = RoundLight::cap(tilted(20), sine(halfAngle), 1.5f);
        const Sh4Light got = sh4Of(cap, vec3(0));
        const float rim = std::cos(halfAngle * kPi / 180);
        for (std::size_t k = 0; k < 16; ++k) {
            const double wanted = integrate(
                [&](vec3 w) { return dot(w, tilted(20)) >= rim ? 1.5f * shBasis(w).c[k] : 0.0f; });
            EXPECT_NEAR(got.radiance[k].y, wanted, 0.01) << halfAngle << ' ' << k;
        }
    }
}

// Unshadowed: the double product of the light with the cosine, whose band 3 is 0.
TEST(Sh4Light, UnshadowedIsTheDoubleProduct)
{
    const RoundLight cap = RoundLight::cap(tilted(35), sine(20), 1);
    const Sh4Light light = sh4Of(cap, vec3(0));
    const ReferenceRadiance got =
        shadeSh4(sceneOf({}), [&](const ReferenceReceiver&) { return light; }, std::span(&kUp, 1),
                 {.samples = 4096});
    double wanted = 0;
    const Sh4 cosine = cosineLobe(vec3(0, 1, 0));
    for (std::size_t k = 0; k < 16; ++k)
        wanted += light.radiance[k].x * cosine.c[k] / kPi;
    EXPECT_NEAR(got.unshadowed[0].x, wanted, 0.005 * wanted);
    EXPECT_EQ(got.shadowed[0], got.unshadowed[0]);
    // A surface that shines gives itself nothing.
    ReferenceReceiver own = kUp;
    own.instance = 3;
    const MeshAsset ball = test::makeSphere(8);
    const std::vector<ReferenceInstance> four(4, {&ball, test::placed(vec3(9, 9, 9)), 0});
    EXPECT_EQ(shadeSh4(
                  sceneOf(four), [&](const ReferenceReceiver&) { return light; },
                  std::span(&own, 1), {.samples = 16}, 3)
                  .unshadowed[0],
              vec3(0));
}

} // namespace
} // namespace penumbra
