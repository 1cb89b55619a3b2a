// The sky filtered by lobes, against sums over its pixels.
#include "systems/sky_lobes.h"

#include "shaders/shared/environment.h"
#include "shaders/shared/instance.h"

#include <gtest/gtest.h>
#include <random>

namespace penumbra {
namespace {

// A gradient with a lamp of 4 x 3 pixels near the zenith and another at the seam.
Environment lampSky()
{
    constexpr std::uint32_t kWidth = 128, kHeight = 64;
    std::vector<vec3> map;
    for (std::uint32_t y = 0; y < kHeight; ++y)
        for (std::uint32_t x = 0; x < kWidth; ++x) {
            const bool lamp = (y >= 4 && y < 7 && x >= 30 && x < 34) ||
                              (y >= 40 && y < 44 && (x < 2 || x >= kWidth - 2));
            map.push_back(vec3(0.2f, 0.3f, 0.6f) * (1 + std::cos(0.05f * static_cast<float>(y))) +
                          (lamp ? vec3(200, 150, 100) : vec3(0)));
        }
    return makeEnvironment(kWidth, kHeight, std::move(map));
}

vec3 summed(const Environment& sky, vec3 direction, double power)
{
    glm::dvec3 sum(0);
    double weights = 0;
    for (std::uint32_t y = 0; y < sky.mapHeight; ++y)
        for (std::uint32_t x = 0; x < sky.mapWidth; ++x) {
            const vec3 d = equirectDirection(
                (vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5f) /
                vec2(static_cast<float>(sky.mapWidth), static_cast<float>(sky.mapHeight)));
            const double t = dot(d, direction);
            if (t <= 0)
                continue;
            const double weight =
                std::pow(t, power) * equirectPixelSolidAngle(sky.mapWidth, sky.mapHeight, y);
            sum += weight * glm::dvec3(sky.map[std::size_t{y} * sky.mapWidth + x]);
            weights += weight;
        }
    return vec3(sum / weights);
}

TEST(SkyLobes, AreTheLobesMeansOfTheSky)
{
    const Environment sky = lampSky();
    const SkyLobes lobes = filterSky(sky);
    ASSERT_EQ(lobes.texels.size(), kSkyLobeTexels);
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    for (const float exponent : {4.0f, 16.0f, 64.0f, 256.0f}) {
        double squares = 0, truth = 0;
        for (int i = 0; i < 300; ++i) {
            vec3 d = normalize(vec3(normal(random), normal(random), normal(random)));
            if (i % 3 == 0) // near a lamp
                d = normalize(equirectDirection(vec2(0.25f, 0.086f)) + 0.2f * d);
            const vec3 expected = summed(sky, d, exponent + 1);
            const vec3 error = filteredSky(lobes, d, exponent) - expected;
            squares += dot(error, error);
            truth += dot(expected, expected);
        }
        const double relative = std::sqrt(squares / truth);
        EXPECT_LT(relative, exponent > 100 ? 0.15 : 0.04) << exponent;
        RecordProperty(std::to_string(exponent), std::to_string(relative));
    }
}

TEST(SkyLobes, OfAnEvenSkyAreEven)
{
    const SkyLobes lobes = filterSky(makeEnvironment(32, 16, std::vector<vec3>(512, vec3(2))));
    for (const vec4& texel : lobes.texels)
        EXPECT_NEAR(texel.x, 2, 1e-5);
}

TEST(SkyLobes, OddMapsAreFiltered)
{
    for (const auto& [width, height] :
         std::vector<std::pair<std::uint32_t, std::uint32_t>>{{1, 1}, {6, 3}, {7, 2}, {4, 256}}) {
        const SkyLobes lobes = filterSky(makeEnvironment(
            width, height, std::vector<vec3>(std::size_t{width} * height, vec3(1))));
        for (const vec4& texel : lobes.texels)
            ASSERT_NEAR(texel.x, 1, 1e-4) << width << " x " << height;
    }
}

TEST(SkyLobes, TurnAndAddUp)
{
    const SkyLobes lobes = filterSky(lampSky());
    const vec4 turn(0.36f, 0.48f, 0, 0.8f);
    SkyLobes sum;
    addTurned(sum, lobes, 2, vec4(0, 0, 0, 1));
    addTurned(sum, lobes, 0.5f, turn);
    for (const float exponent : {4.0f, 40.0f, 1024.0f})
        for (const vec3& d : {vec3(0, 1, 0), vec3(0.6f, 0, 0.8f), vec3(-1, 0, 0)}) {
            const vec3 turned = rotate(vec4(-vec3(turn), turn.w), d);
            const vec3 expected = 2.0f * filteredSky(lobes, d, exponent) +
                                  0.5f * filteredSky(lobes, turned, exponent);
            EXPECT_LT(length(filteredSky(sum, d, exponent) - expected), 0.01f * length(expected));
        }
}

} // namespace
} // namespace penumbra
