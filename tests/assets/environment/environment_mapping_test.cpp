// The equirectangular mapping. A map that is upside down or mirrored still looks like a sky, so
// each axis is checked by name, not only that the two functions undo each other.
#include "shaders/shared/environment.h"

#include "assets/environment.h"

#include <gtest/gtest.h>
#include <numbers>
#include <random>

namespace penumbra {

namespace {

void expectNear(vec3 a, vec3 b, float tolerance)
{
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(EnvironmentMapping, NamedDirections)
{
    expectNear(equirectDirection({0.5f, 0.5f}), {1, 0, 0}, 1e-6f);
    expectNear(equirectDirection({0.75f, 0.5f}), {0, 0, 1}, 1e-6f);
    expectNear(equirectDirection({0.25f, 0.5f}), {0, 0, -1}, 1e-6f);
    expectNear(equirectDirection({0.0f, 0.5f}), {-1, 0, 0}, 1e-6f);
    expectNear(equirectDirection({0.3f, 0.0f}), {0, 1, 0}, 1e-6f);
    expectNear(equirectDirection({0.3f, 1.0f}), {0, -1, 0}, 1e-6f);
}

// Seen from inside with +Y up, what lies right in the picture lies right in the world: forward x up
// = right.
TEST(EnvironmentMapping, IsNotMirrored)
{
    for (float u = 0.0f; u < 1.0f; u += 0.1f) {
        const vec3 forward = equirectDirection({u, 0.5f});
        const vec3 right = cross(forward, vec3(0, 1, 0));
        EXPECT_GT(dot(equirectDirection({u + 0.01f, 0.5f}), right), 0.0f) << u;
    }
}

TEST(EnvironmentMapping, UvUndoesDirection)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(0.01f, 0.99f);
    for (int i = 0; i < 1000; ++i) {
        const vec2 uv(unit(random), unit(random));
        const vec2 back = equirectUv(equirectDirection(uv));
        EXPECT_NEAR(back.x, uv.x, 2e-5f);
        EXPECT_NEAR(back.y, uv.y, 2e-5f);
    }
    EXPECT_FLOAT_EQ(equirectUv({0, 1, 0}).y, 0.0f);
    EXPECT_FLOAT_EQ(equirectUv({0, -1, 0}).y, 1.0f);
}

TEST(EnvironmentMapping, PixelsCoverTheSphereOnce)
{
    for (const auto& [width, height] : {std::pair{1u, 1u}, {8u, 3u}, {512u, 256u}}) {
        double sum = 0.0;
        for (std::uint32_t y = 0; y < height; ++y)
            sum += width * equirectPixelSolidAngle(width, height, y);
        EXPECT_NEAR(sum, 4.0 * std::numbers::pi, 1e-12);
    }
}

} // namespace

} // namespace penumbra
