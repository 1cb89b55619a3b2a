// Projection of a map to SH, and the basis of any order behind it.
#include "assets/environment.h"
#include "assets/sh_basis.h"
#include "shaders/shared/environment.h"
#include "shaders/shared/sh.h"

#include <gtest/gtest.h>
#include <numbers>
#include <random>

namespace penumbra {

namespace {

vec3 randomDirection(std::mt19937& random)
{
    std::normal_distribution<float> normal;
    return normalize(vec3(normal(random), normal(random), normal(random)));
}

TEST(ShBasisAnyOrder, EqualsTheSharedBasisOfOrder4)
{
    std::mt19937 random(1);
    for (int i = 0; i < 200; ++i) {
        const vec3 d = randomDirection(random);
        std::array<double, 16> any{};
        shBasisAnyOrder(4, d, any);
        const Sh4 shared = shBasis(d);
        for (int k = 0; k < 16; ++k)
            EXPECT_NEAR(any[k], shared.c[k], 2e-6) << k;
    }
}

// The addition theorem: the squares of a band sum to (2l + 1) / 4 pi in every direction.
TEST(ShBasisAnyOrder, BandsFollowTheAdditionTheorem)
{
    std::mt19937 random(2);
    for (int i = 0; i < 100; ++i) {
        std::array<double, 144> basis{};
        shBasisAnyOrder(12, normalize(glm::dvec3(randomDirection(random))), basis);
        for (int l = 0; l < 12; ++l) {
            double sum = 0.0;
            for (int k = l * l; k < (l + 1) * (l + 1); ++k)
                sum += basis[k] * basis[k];
            EXPECT_NEAR(sum, (2 * l + 1) / (4.0 * std::numbers::pi), 1e-9) << l;
        }
    }
}

TEST(EnvironmentProjection, UniformSkyIsBandZero)
{
    for (const auto& [width, height] : {std::pair{1u, 1u}, {6u, 3u}, {512u, 256u}}) {
        const Environment e =
            makeEnvironment(width, height, std::vector<vec3>(width * height, vec3(1, 2, 0.5f)));
        EXPECT_NEAR(e.sh6[0].r, kSqrt4Pi, 1e-4f);
        EXPECT_NEAR(e.sh6[0].g, 2 * kSqrt4Pi, 2e-4f);
        EXPECT_NEAR(e.sh6[0].b, 0.5f * kSqrt4Pi, 1e-4f);
        for (int k = 1; k < 36; ++k)
            EXPECT_NEAR(e.sh6[k].g, 0.0f, 2e-4f) << k; // the midpoint rule on 256 rows
        EXPECT_NEAR(e.statistics.meanLuminance, luminance({1, 2, 0.5f}), 1e-5f);
        EXPECT_NEAR(environmentEnergyShare(e, 4), 1.0, 1e-4);
    }
}

// A bright pixel in the map appears in the SH in the direction that the pixel looks at, for every
// octant: no axis is swapped or mirrored between map and SH.
TEST(EnvironmentProjection, BrightSpotPointsWhereItsPixelLooks)
{
    constexpr std::uint32_t kWidth = 64, kHeight = 32;
    for (const vec3 wanted :
         {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1), vec3(-1, 0, 0), vec3(0, -1, 0),
          vec3(0, 0, -1), vec3(1, 2, 3), vec3(-3, 1, -2), vec3(2, -3, 1)}) {
        const vec2 uv = equirectUv(normalize(wanted));
        const auto x = std::min(static_cast<std::uint32_t>(uv.x * kWidth), kWidth - 1);
        const auto y = std::min(static_cast<std::uint32_t>(uv.y * kHeight), kHeight - 1);
        std::vector<vec3> map(kWidth * kHeight, vec3(0));
        map[y * kWidth + x] = vec3(100);
        const Environment e = makeEnvironment(kWidth, kHeight, std::move(map));
        const vec3 linear(e.sh4[3].r, e.sh4[1].r, e.sh4[2].r);
        EXPECT_GT(dot(normalize(linear), normalize(wanted)), 0.995f)
            << wanted.x << ' ' << wanted.y << ' ' << wanted.z;
    }
}

// A function of order 6, put into a map, comes back.
TEST(EnvironmentProjection, ReturnsTheCoefficientsOfABandLimitedMap)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-0.1, 0.1);
    std::array<double, 36> wanted{};
    for (double& c : wanted)
        c = unit(random);
    wanted[0] = 3.0; // keeps the map positive
    std::vector<vec3> map(512 * 256);
    for (std::uint32_t i = 0; i < map.size(); ++i) {
        std::array<double, 36> basis{};
        shBasisAnyOrder(6, equirectDirection({(i % 512 + 0.5f) / 512, (i / 512 + 0.5f) / 256}),
                        basis);
        double value = 0.0;
        for (int k = 0; k < 36; ++k)
            value += wanted[k] * basis[k];
        map[i] = vec3(static_cast<float>(value));
    }
    const Environment e = makeEnvironment(512, 256, std::move(map));
    for (int k = 0; k < 36; ++k)
        EXPECT_NEAR(e.sh6[k].g, wanted[k], 5e-4) << k;
    for (int k = 0; k < 16; ++k)
        EXPECT_EQ(e.sh4[k], e.sh6[k]);
    EXPECT_GT(environmentEnergyShare(e, 6), 0.9999);
    EXPECT_LT(environmentEnergyShare(e, 4), environmentEnergyShare(e, 6));
}

} // namespace

} // namespace penumbra
