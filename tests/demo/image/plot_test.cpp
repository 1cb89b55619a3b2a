#include "demo/image/plot.h"

#include <gtest/gtest.h>

namespace penumbra {
namespace {

constexpr Color kRed{255, 0, 0};

bool isRed(const Image8& image, std::uint32_t x, std::uint32_t y)
{
    const std::uint8_t* p = &image.rgba[4 * (std::size_t{y} * image.width + x)];
    return p[0] > 200 && p[1] < 60 && p[2] < 60;
}

// Mean place of the red pixels above the legend.
vec2 middleOfRed(const Image8& image)
{
    vec2 sum(0);
    float count = 0;
    for (std::uint32_t y = 0; y < image.height * 3 / 4; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x)
            if (isRed(image, x, y)) {
                sum += vec2(x, y);
                ++count;
            }
    EXPECT_GT(count, 10);
    return sum / count;
}

Image8 plotOf(vec2 point)
{
    return drawPlot({.title = "t",
                     .xLabel = "x",
                     .yLabel = "y",
                     .xTicks = {1, 10, 100},
                     .curves = {{"curve", kRed, false, {point}},
                                {"ends", {0, 0, 255}, true, {{1, 0.001f}, {100, 1}}}}},
                    500, 420);
}

// Equal factors are equal steps, on both axes; up is more.
TEST(Plot, AxesAreLogarithmic)
{
    const vec2 a = middleOfRed(plotOf({2, 0.01f})), b = middleOfRed(plotOf({6, 0.1f})),
               c = middleOfRed(plotOf({18, 1}));
    EXPECT_GT(b.x, a.x + 20);
    EXPECT_LT(b.y, a.y - 20);
    EXPECT_NEAR(b.x - a.x, c.x - b.x, 2);
    EXPECT_NEAR(b.y - a.y, c.y - b.y, 2);
}

TEST(Plot, HasItsSizeAndIsTheSameEachTime)
{
    const Image8 once = plotOf({10, 0.1f});
    EXPECT_EQ(once.width, 500u);
    EXPECT_EQ(once.height, 420u);
    EXPECT_EQ(once.rgba, plotOf({10, 0.1f}).rgba);
}

// What has no logarithm is left out, and nothing to show is an empty plot.
TEST(Plot, LeavesOutWhatIsNotPositive)
{
    Plot plot{.xTicks = {1, 2}, .curves = {{"none", kRed, false, {{1, 0}, {1.5f, -1}}}}};
    const Image8 image = drawPlot(plot, 320, 320);
    for (std::uint32_t y = 0; y < 240; ++y)
        for (std::uint32_t x = 0; x < 320; ++x)
            ASSERT_FALSE(isRed(image, x, y));
}

} // namespace
} // namespace penumbra
