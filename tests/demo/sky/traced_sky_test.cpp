// Several environments for rays: the sum of each alone, and the same light as the fields have.
#include "demo/traced_sky.h"

#include "demo/reference/reference.h"
#include "demo/reference/sampling.h"
#include "systems/environment_lighting.h"
#include "tests/demo/reference/reference_scenes.h"
#include "tests/systems/environment/test_skies.h"

#include <gtest/gtest.h>

namespace penumbra {
namespace {

using test::lampSky;

struct Skies {
    Environment lamp = lampSky(), smooth = makeSky(32, 16, lopsided);
    ReferenceLight a = ReferenceLight::fromMap(lamp, rotationMatrix(yaw(0.9f)), 0.4f);
    ReferenceLight b =
        ReferenceLight::fromMap(smooth, rotationMatrix(turnAbout(vec3(1, 2, 0), 2)), 1.5f);
    ReferenceLight both = ReferenceLight::sum(std::array{a, b});
};

TEST(ReferenceLightSum, RadianceAndDensityAreThoseOfTheMixture)
{
    const Skies skies;
    constexpr std::uint32_t kCount = 1 << 14;
    double inverse = 0, power = 0;
    int different = 0;
    for (const glm::uvec2 p : makeSamplePoints(kCount)) {
        const ReferenceLight::Sample sample = skies.both.sample(scramble(p, {5, 9}));
        const ReferenceLight::Value value = skies.both.evaluate(sample.direction);
        const ReferenceLight::Value own = skies.both.evaluate(sample);
        different += std::abs(value.pdf - own.pdf) > 1e-3f * own.pdf;
        const vec3 wanted = skies.a.evaluate(sample.direction).radiance +
                            skies.b.evaluate(sample.direction).radiance;
        ASSERT_LT(length(value.radiance - wanted), 1e-5f * length(wanted));
        inverse += 1.0 / own.pdf / kCount;
        power += own.radiance.g / own.pdf / kCount;
    }
    EXPECT_LT(different, kCount / 500); // on the borders of pixels
    constexpr double kPi = std::numbers::pi;
    EXPECT_NEAR(inverse, 4 * kPi, 0.1);
    const double wanted =
        (0.4 * skies.lamp.sh4[0].g + 1.5 * skies.smooth.sh4[0].g) * std::sqrt(4 * kPi);
    EXPECT_NEAR(power / wanted, 1, 5e-3);
}

TEST(ReferenceLightSum, OfOneIsThatOneToTheBit)
{
    const Skies skies;
    const ReferenceLight black = ReferenceLight::fromMap(test::uniformSky(vec3(0)));
    const ReferenceLight off = ReferenceLight::fromMap(skies.smooth, mat3(1), 0);
    const ReferenceLight sum = ReferenceLight::sum(std::array{black, skies.a, off});
    for (const glm::uvec2 p : makeSamplePoints(256)) {
        const ReferenceLight::Sample s = sum.sample(scramble(p, {1, 2}));
        EXPECT_EQ(s.direction, skies.a.sample(scramble(p, {1, 2})).direction);
        EXPECT_EQ(sum.evaluate(s).radiance, skies.a.evaluate(s).radiance);
        EXPECT_EQ(sum.evaluate(s).pdf, skies.a.evaluate(s).pdf);
    }
    EXPECT_TRUE(ReferenceLight::sum({}).black());
    EXPECT_TRUE(ReferenceLight::sum(std::array{black, off}).black());
    EXPECT_EQ(ReferenceLight::sum({}).evaluate(vec3(0, 1, 0)).radiance, vec3(0));
}

// Light adds up, whatever stands in it; the mixture costs no more noise than its parts.
TEST(ReferenceLightSum, ReceiversGetWhatTheyGetOfEach)
{
    const Skies skies;
    const MeshAsset sphere = test::makeSphere(32);
    const std::vector<ReferenceInstance> instances = {
        {&sphere, test::placed({0, 1.5f, 0.3f}, 0.6f), 0}};
    const std::vector<MeshMaterial> materials = {{vec3(0.8f), 0, 0}};
    Result<ReferenceScene> scene = ReferenceScene::build(instances, materials);
    ASSERT_TRUE(scene);
    std::vector<ReferenceReceiver> receivers;
    for (int i = 0; i < 100; ++i)
        receivers.push_back({vec3(0.02f * static_cast<float>(i) - 1, 0, 0)});
    const auto shade = [&](const ReferenceLight& light) {
        return shadeReference(*scene, light, receivers, {.samples = 8192});
    };
    const ReferenceRadiance a = shade(skies.a), b = shade(skies.b), both = shade(skies.both);
    std::vector<vec3> shadowed, unshadowed;
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        shadowed.push_back(a.shadowed[i] + b.shadowed[i]);
        unshadowed.push_back(a.unshadowed[i] + b.unshadowed[i]);
    }
    const RadianceErrors errors = compareRadiance(both.shadowed, shadowed, unshadowed);
    EXPECT_LT(errors.rmseRelative, 0.01);
    EXPECT_LT(std::abs(errors.bias), 0.002 * errors.meanUnshadowed);
    EXPECT_GT(compareRadiance(shadowed, unshadowed, unshadowed).rmseRelative, 0.03);
}

// Directions rotated here, coefficients there; over ground and without.
TEST(TracedSky, IsTheLightThatTheFieldsHave)
{
    for (const bool ground : {false, true}) {
        DemoScene scene;
        if (ground)
            scene.world.create(Ground{});
        const AssetHandle day = scene.assets.addEnvironment(makeSky(64, 32, lopsided));
        const AssetHandle dusk = scene.assets.addEnvironment(makeSky(32, 16, evening));
        const std::vector<EnvironmentLight> lights = {
            {day, 0.7f, yaw(1.2f)}, {dusk, 0.4f, turnAbout(vec3(1, 0.3f, 0), 0.5f)}, {day, 0}};
        for (const EnvironmentLight& light : lights)
            scene.world.create(light);
        const TracedSky traced = tracedSky(scene);
        EnvironmentLighting lighting(scene.assets, ground);
        lighting.set(lights);
        for (const glm::uvec2 p : makeSamplePoints(256)) {
            const vec2 u = scramble(p, {3, 4});
            const vec3 d = equirectDirection(u);
            vec3 wanted(0);
            for (int k = 0; k < 16; ++k)
                wanted += shBasis(d).c[k] * lighting.light()[static_cast<std::size_t>(k)];
            ASSERT_LT(length(traced.order4.evaluate(d).radiance - wanted), 1e-4f);
            if (ground && d.y < -0.2f) { // lower than a pixel of the smaller map
                ASSERT_EQ(traced.maps.evaluate(d).radiance, vec3(0));
            }
        }
    }
}

// With beams: what they leave in SH, and the rest of the map whole, which sums up to their light.
TEST(TracedSky, SharesTheLightAmongFieldsAndBeams)
{
    DemoScene scene;
    const AssetHandle day = scene.assets.addEnvironment(makeSky(64, 32, lopsided));
    const AssetHandle dusk = scene.assets.addEnvironment(makeSky(32, 16, evening));
    const std::vector<EnvironmentLight> lights = {{day, 0.7f, yaw(1.2f)}, {dusk, 0.4f, yaw(2)}};
    for (const EnvironmentLight& light : lights)
        scene.world.create(light);
    const TracedSky traced = tracedSky(scene, 12);
    EnvironmentLighting lighting(scene.assets, false, 12);
    lighting.set(lights);
    ASSERT_EQ(lighting.beams().size(), 12u);
    float power = 0, wanted = 0;
    constexpr std::uint32_t kCount = 1 << 14;
    for (const glm::uvec2 p : makeSamplePoints(kCount)) {
        const vec2 u = scramble(p, {3, 4});
        const float y = 1 - 2 * u.y, ring = std::sqrt(1 - y * y);
        const float azimuth = 2 * std::numbers::pi_v<float> * u.x;
        const vec3 d(ring * std::cos(azimuth), y, ring * std::sin(azimuth));
        vec3 fields(0);
        for (int k = 0; k < 16; ++k)
            fields += shBasis(d).c[k] * lighting.light()[static_cast<std::size_t>(k)];
        const vec3 bright = traced.order4.evaluate(d).radiance - fields;
        const vec3 whole = traced.maps.evaluate(d).radiance;
        ASSERT_TRUE(glm::all(glm::greaterThan(bright, vec3(-1e-3f))));
        ASSERT_TRUE(glm::all(glm::lessThan(bright, whole)));
        power += bright.g * 4 * std::numbers::pi_v<float> / kCount;
    }
    for (const SkyBeam& beam : lighting.beams()) // across the beam: by the mean cosine of its disc
        wanted += beam.irradiance.g / std::sqrt(1 - beam.halfAngle * beam.halfAngle / 2);
    EXPECT_NEAR(power / wanted, 1, 0.01);
}

} // namespace
} // namespace penumbra
