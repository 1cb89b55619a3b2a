// FLIP against its definition.
#include "demo/image/flip.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace penumbra {

namespace {

template <class F>
Image8 paint(std::uint32_t width, std::uint32_t height, const F& color)
{
    Image8 image = makeImage(width, height);
    for (int i = 0; i < static_cast<int>(width * height); ++i) {
        const glm::ivec3 c = color(i % static_cast<int>(width), i / static_cast<int>(width));
        for (int k = 0; k < 3; ++k)
            image.rgba[4 * i + k] = static_cast<std::uint8_t>(c[k]);
    }
    return image;
}

glm::ivec3 pattern(int x, int y)
{
    return {(x * 37 + y * 11) % 256, (x * x + 3 * y) % 256, (x * 5 + y * y * 2) % 256};
}

glm::ivec3 changedPattern(int x, int y)
{
    const glm::ivec3 c = pattern(x, y);
    return (x + y) % 5 == 0 ? glm::ivec3((c.r + 40) % 256, c.g, c.b / 2)
                            : glm::ivec3(std::min(c.r + 9, 255), c.g, c.b);
}

TEST(Flip, ZeroForEqualPictures)
{
    const Image8 image = paint(40, 30, pattern);
    const FlipResult result = flipMap(image, image);
    EXPECT_EQ(result.mean, 0.0);
    EXPECT_EQ(*std::max_element(result.map.begin(), result.map.end()), 0.0f);
}

// HyAB of black and white is 100; 100^0.7 through the remapping of section 4.1.
TEST(Flip, BlackAgainstWhite)
{
    EXPECT_NEAR(flip(makeImage(32, 32), makeImage(32, 32, {255, 255, 255, 255})), 0.96738, 1e-4);
}

// Numbers of an independent evaluation in doubles: the paper's formulas as direct sums over
// two-dimensional kernels.
TEST(Flip, EqualsADirectEvaluation)
{
    const FlipResult result = flipMap(paint(24, 24, pattern), paint(24, 24, changedPattern), 20.0);
    EXPECT_NEAR(result.mean, 0.24191, 2e-5);
    EXPECT_NEAR(result.map[7 * 24 + 5], 0.093395, 2e-5);
    EXPECT_NEAR(result.map[0], 0.180254, 2e-5);
}

TEST(Flip, IsSymmetricAndDeterministic)
{
    const Image8 a = paint(50, 20, pattern), b = paint(50, 20, changedPattern);
    EXPECT_EQ(flipMap(a, b).map, flipMap(b, a).map);
    EXPECT_EQ(flipMap(a, b).map, flipMap(a, b).map);
}

TEST(Flip, GrowsWithTheDifferenceAndShrinksWithDistance)
{
    const auto flat = [](int level) { return [level](int, int) { return glm::ivec3(level); }; };
    const Image8 grey = paint(32, 32, flat(128));
    EXPECT_LT(flip(grey, paint(32, 32, flat(130))), flip(grey, paint(32, 32, flat(140))));
    // Dither of one pixel: seen from far away it is grey.
    const Image8 dither =
        paint(64, 64, [](int x, int y) { return glm::ivec3((x + y) % 2 == 0 ? 120 : 136); });
    const Image8 flat64 = paint(64, 64, flat(128));
    EXPECT_LT(flip(flat64, dither, 200.0), 0.5 * flip(flat64, dither, 10.0));
}

} // namespace

} // namespace penumbra
