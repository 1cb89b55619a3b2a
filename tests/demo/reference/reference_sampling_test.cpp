// The samples of the reference: nets, the reflectance's and the light's distributions.
#include "demo/reference/light.h"
#include "demo/reference/sampling.h"
#include "tests/demo/reference/reference_scenes.h"

#include <gtest/gtest.h>
#include <set>

namespace penumbra {

namespace {

constexpr float kPi = std::numbers::pi_v<float>;

MeshMaterial glossy(float fraction, float exponent)
{
    return {vec3(1), fraction, exponent};
}

// Every elementary box of a (0, m, 2)-net holds one point, after a shift too.
TEST(ReferenceSampling, PointsAreANetUnderAnyShift)
{
    const std::vector<glm::uvec2> points = makeSamplePoints(256);
    for (const glm::uvec2 shift : {glm::uvec2(0), glm::uvec2(0xdeadbeef, 0x12345678)}) {
        for (int columns = 0; columns <= 8; ++columns) {
            std::set<std::pair<int, int>> boxes;
            for (const glm::uvec2 p : points) {
                const vec2 u = scramble(p, shift);
                ASSERT_TRUE(u.x >= 0 && u.x < 1 && u.y >= 0 && u.y < 1);
                boxes.emplace(static_cast<int>(std::ldexp(u.x, columns)),
                              static_cast<int>(std::ldexp(u.y, 8 - columns)));
            }
            EXPECT_EQ(boxes.size(), 256u) << columns;
        }
    }
}

TEST(ReferenceSampling, FrameIsOrthonormal)
{
    for (const vec3 n : {vec3(0, 0, 1), vec3(0, 0, -1), vec3(1, 0, 0), normalize(vec3(1, -2, 3))}) {
        const Frame f(n);
        const mat3 m(f.x, f.y, f.z);
        const mat3 square = glm::transpose(m) * m;
        for (int i = 0; i < 3; ++i)
            EXPECT_LT(length(square[i] - mat3(1)[i]), 1e-6f);
        EXPECT_GT(glm::determinant(m), 0.999f);
    }
}

// E[g / pdf] over the samples is the integral of g, for g = 1 and for g = f over the directions
// above the plane.
TEST(ReferenceSampling, ReflectanceSamplesFollowTheirDensity)
{
    const vec3 n = normalize(vec3(0.2f, 1, -0.3f)), v = normalize(vec3(1, 1.5f, 0.4f));
    for (const MeshMaterial& material : {glossy(0, 0), glossy(0.4f, 12), glossy(1, 60)}) {
        const Reflectance r(n, v, material);
        double above = 0.0, throughput = 0.0, pdfIntegral = 0.0, fIntegral = 0.0;
        constexpr std::uint32_t kCount = 1 << 16;
        for (const glm::uvec2 p : makeSamplePoints(kCount)) {
            const vec2 u = scramble(p, {0x1234567, 0x89abcdef});
            const Reflectance::Value sampled = r.evaluate(r.sample(u));
            if (sampled.pdf > 0.0f) {
                above += 1.0 / kCount;
                throughput += sampled.f / sampled.pdf / kCount;
            }
            const float y = 1.0f - 2.0f * u.y, radius = std::sqrt(1.0f - y * y);
            const Reflectance::Value even =
                r.evaluate({radius * std::cos(2 * kPi * u.x), y, radius * std::sin(2 * kPi * u.x)});
            pdfIntegral += 4 * kPi * even.pdf / kCount;
            fIntegral += 4 * kPi * even.f / kCount;
        }
        EXPECT_NEAR(above, pdfIntegral, 0.01);
        EXPECT_NEAR(throughput, fIntegral, 0.01);
    }
}

// Looking along the normal, the lobe is not cut by the plane and the integral of f is known:
// (1 - g) + g (e + 2) integral of c^(e+1) dc = 1 for any g, e.
TEST(ReferenceSampling, ReflectanceConservesEnergyAlongTheNormal)
{
    for (const MeshMaterial& material : {glossy(0, 0), glossy(0.5f, 8), glossy(1, 50)}) {
        const Reflectance r({0, 1, 0}, {0, 1, 0}, material);
        double sum = 0.0;
        constexpr std::uint32_t kCount = 1 << 14;
        for (const glm::uvec2 p : makeSamplePoints(kCount)) {
            const Reflectance::Value value = r.evaluate(r.sample(scramble(p, glm::uvec2(0))));
            sum += value.pdf > 0.0f ? value.f / value.pdf / kCount : 0.0;
        }
        EXPECT_NEAR(sum, 1.0, 1e-3);
    }
    const Reflectance r({0, 1, 0}, {0, 1, 0}, glossy(0.5f, 8));
    EXPECT_EQ(r.evaluate({0, -1, 0}).f, 0.0f);
    EXPECT_NEAR(r.evaluate({0, 1, 0}).f, 0.5f / kPi + 0.5f * 10 / (2 * kPi), 1e-6f);
}

// A sample's value is what evaluate says of its direction, up to the pixel borders; the density
// integrates to 1.
TEST(ReferenceLight, SamplesAndEvaluationAgree)
{
    const mat3 turn(glm::mat3_cast(glm::angleAxis(1.1f, normalize(vec3(1, 2, -1)))));
    const Environment sky = test::lampSky();
    for (const ReferenceLight& light :
         {ReferenceLight::fromMap(sky, turn, 2.0f), ReferenceLight::fromSh4(sky.sh4, turn, 2.0f)}) {
        int different = 0;
        double inverse = 0.0, power = 0.0, powerEven = 0.0, integral = 0.0;
        constexpr std::uint32_t kCount = 1 << 16;
        for (const glm::uvec2 p : makeSamplePoints(kCount)) {
            const vec2 u = scramble(p, {77, 99});
            const ReferenceLight::Sample sample = light.sample(u);
            ASSERT_NEAR(length(sample.direction), 1.0f, 1e-5f);
            const ReferenceLight::Value own = light.evaluate(sample);
            const ReferenceLight::Value value = light.evaluate(sample.direction);
            different += std::abs(value.pdf - own.pdf) > 1e-3f * own.pdf;
            inverse += 1.0 / own.pdf / kCount;
            power += own.radiance.g / own.pdf / kCount;
            const float y = 1.0f - 2.0f * u.y, radius = std::sqrt(1.0f - y * y);
            const ReferenceLight::Value even = light.evaluate(
                {radius * std::cos(2 * kPi * u.x), y, radius * std::sin(2 * kPi * u.x)});
            integral += 4 * kPi * even.pdf / kCount;
            powerEven += 4 * kPi * even.radiance.g / kCount;
        }
        EXPECT_LT(different, kCount / 500);
        EXPECT_NEAR(inverse, 4 * kPi, 0.05);
        EXPECT_NEAR(integral, 1.0, 0.05);
        EXPECT_NEAR(power / (2.0 * sky.sh4[0].g * std::sqrt(4 * kPi)), 1.0, 2e-3);
        EXPECT_NEAR(powerEven / power, 1.0, 0.05);
    }
}

TEST(ReferenceLight, TheLampIsWhereTheMapShowsIt)
{
    std::vector<vec3> map(64 * 32, vec3(0));
    map[7 * 64 + 20] = vec3(1);
    const ReferenceLight light = ReferenceLight::fromMap(makeEnvironment(64, 32, std::move(map)));
    const vec3 lamp = equirectDirection({20.5f / 64, 7.5f / 32});
    EXPECT_EQ(light.evaluate(lamp).radiance, vec3(1));
    EXPECT_EQ(light.evaluate(-lamp).radiance, vec3(0));
    for (const vec2 u : {vec2(0.1f, 0.2f), vec2(0.9f, 0.7f), vec2(0.0f), vec2(0.9999999f)})
        EXPECT_GT(dot(light.sample(u).direction, lamp), 0.995f);
}

} // namespace

} // namespace penumbra
