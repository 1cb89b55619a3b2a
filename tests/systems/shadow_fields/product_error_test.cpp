// The kernels against brute force: spheres of random size and place over a matte receiver, under
// random light of order 4. What is compared includes all that a frame does: sampled fields of 8
// bits, rotations and products.
#include "tests/systems/shadow_fields/test_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/gtc/constants.hpp>
#include <random>
#include <tuple>

namespace penumbra {
namespace {

constexpr float kRadius = 0.5f; // of the sphere asset
constexpr int kConfigurations = 120;
constexpr int kDirections = 6000;

class Random {
public:
    float uniform(float low, float high)
    {
        return low + (high - low) * static_cast<float>(m_engine() >> 8) * 0x1p-24f;
    }
    vec3 direction()
    {
        const float z = uniform(-1, 1), a = uniform(0, 2 * glm::pi<float>());
        const float s = std::sqrt(1 - z * z);
        return vec3(s * std::cos(a), s * std::sin(a), z);
    }

private:
    std::mt19937 m_engine{7};
};

// Uniform over the sphere (Fibonacci's spiral).
std::vector<vec3> directions()
{
    std::vector<vec3> result;
    for (int i = 0; i < kDirections; ++i) {
        const double z = 1 - (2 * i + 1) / static_cast<double>(kDirections);
        const double a = 2.399963229728653 * i, s = std::sqrt(1 - z * z);
        result.emplace_back(s * std::cos(a), s * std::sin(a), z);
    }
    return result;
}

enum class Sky { Uniform, Lobes };

Sh4 lightOf(Sky sky, Random& random)
{
    Sh4 light{};
    light.c[0] = kSqrt4Pi;
    if (sky == Sky::Uniform)
        return light;
    for (int lobe = 0; lobe < 3; ++lobe) {
        const Sh4 add = shZonal(random.direction(), vec4(1.5f, 1.2f, 0.8f, 0.4f));
        light = shAdd(light, add);
    }
    return light;
}

// Visibility behind a sphere of angular radius asin(s) at the unit `axis`: order 4 of 1 - cap.
Sh4 exactVisibility(vec3 axis, float s)
{
    const double c = std::sqrt(1 - static_cast<double>(s) * s);
    // 2 pi times the integral of P_l over [c, 1].
    const double two = 2 * glm::pi<double>();
    const vec4 cap(two * (1 - c), two * (1 - c * c) / 2, two * (c - c * c * c) / 2,
                   two * (-5 * std::pow(c, 4) + 6 * c * c - 1) / 8);
    Sh4 visibility = shZonal(axis, -cap);
    visibility.c[0] += kSqrt4Pi;
    return visibility;
}

struct Rmse {
    double field = 0, chain = 0; // relative to the mean unshadowed irradiance
};

// `hide`: each one hides others.
Rmse measure(Kernel kernel, int occluders, Sky sky, bool hide)
{
    static const std::vector<MeshAsset> kAssets = {makeBoxAsset(vec3(1e-3f), 1, false),
                                                   makeFineSphereAsset(kRadius)};
    static const std::vector<vec3> kRays = directions();
    std::vector<const MeshAsset*> meshes = {&kAssets[0], &kAssets[1]};
    std::vector<SceneInstance> instances(1 + static_cast<std::size_t>(occluders));
    instances[0].material = {vec3(1), 0, 0};
    for (std::size_t i = 1; i < instances.size(); ++i)
        instances[i] = {.mesh = 0, .occluder = 1}; // the field alone: nobody looks at the spheres
    SceneData scene = buildSceneData(meshes, instances);
    scene.hiders.assign(instances.size(), hide);
    const auto up = std::find(kAssets[0].normals.begin(), kAssets[0].normals.end(), vec3(0, 1, 0));
    const auto receiver = static_cast<std::size_t>(up - kAssets[0].normals.begin());
    const vec3 origin = kAssets[0].positions[receiver];

    Random random;
    double fieldSum = 0, chainSum = 0, unshadowedSum = 0;
    for (int configuration = 0; configuration < kConfigurations; ++configuration) {
        struct Ball {
            vec3 to;
            float radius;
        };
        std::vector<Ball> balls;
        for (std::size_t i = 1; i < instances.size(); ++i) {
            Ball ball{random.direction(), random.uniform(0.1f, 0.6f)};
            ball.to.y = std::abs(ball.to.y);
            ball.to *= ball.radius * random.uniform(1.3f, 5.0f);
            balls.push_back(ball);
            scene.instances[i].position = origin + ball.to;
            scene.instances[i].scale = ball.radius / kRadius;
        }
        const Sh4 light = lightOf(sky, random);
        LightSh light6{};
        for (std::size_t k = 0; k < 16; ++k)
            light6[k] = vec3(light.c[k]);

        double truth = 0, unshadowed = 0;
        for (const vec3& d : kRays) {
            const double value = std::max(d.y, 0.0f) * shDot(light, shBasis(d)) * 4.0 / kDirections;
            const bool blocked = std::any_of(balls.begin(), balls.end(), [&](const Ball& ball) {
                const float along = dot(ball.to, d);
                return along > 0 &&
                       dot(ball.to, ball.to) - along * along < ball.radius * ball.radius;
            });
            unshadowed += value;
            truth += blocked ? 0 : value;
        }
        std::sort(balls.begin(), balls.end(),
                  [](const Ball& a, const Ball& b) { return length(a.to) < length(b.to); });
        Sh4 chain = cosineLobe(vec3(0, 1, 0));
        for (const Ball& ball : balls)
            chain = shProduct(exactVisibility(normalize(ball.to), ball.radius / length(ball.to)),
                              chain);
        const double chained = shDot(chain, light) / glm::pi<double>();
        const double field = shadeAll(kernel, scene, frameConstants({}, light6, 1))[receiver].x;
        fieldSum += (field - truth) * (field - truth);
        chainSum += (chained - truth) * (chained - truth);
        unshadowedSum += unshadowed;
    }
    const double mean = unshadowedSum / kConfigurations;
    return {std::sqrt(fieldSum / kConfigurations) / mean,
            std::sqrt(chainSum / kConfigurations) / mean};
}

class ProductError : public ::testing::TestWithParam<std::tuple<Kernel, bool>> {};

TEST_P(ProductError, IsThatOfOrder4AgainstBruteForce)
{
    const auto [kernel, hide] = GetParam();
    for (const int occluders : {1, 4, 8, 12}) {
        const Rmse rmse = measure(kernel, occluders, Sky::Lobes, hide);
        if (occluders == 1) {
            EXPECT_LE(rmse.field, 0.010);
        } else {
            EXPECT_LE(rmse.field, 1.15 * rmse.chain) << occluders;
        }
        RecordProperty(
            fmt::format("of{}", occluders),
            fmt::format("{:.4f} against {:.4f} of the exact chain", rmse.field, rmse.chain));
    }
}

TEST_P(ProductError, UnderAUniformSkyIsSmall)
{
    const auto [kernel, hide] = GetParam();
    const Rmse rmse = measure(kernel, 8, Sky::Uniform, hide);
    EXPECT_LE(rmse.field, 0.035);
    RecordProperty("of8", std::to_string(rmse.field));
}

INSTANTIATE_TEST_SUITE_P(Kernels, ProductError,
                         ::testing::Combine(::testing::Values(Kernel::Literal, Kernel::Exact),
                                            ::testing::Bool()));

} // namespace
} // namespace penumbra
