// PNG files and pictures of numbers.
#include "demo/image/image.h"
#include "shaders/shared/tone_map.h"

#include "runtime/file.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <random>
#include <string_view>

namespace penumbra {

namespace {

Image8 noise(std::uint32_t width, std::uint32_t height)
{
    Image8 image = makeImage(width, height);
    std::mt19937 random(1);
    for (std::uint8_t& c : image.rgba)
        c = static_cast<std::uint8_t>(random());
    return image;
}

TEST(Png, RoundTripIsExact)
{
    for (const auto& [width, height] : {std::pair{1u, 1u}, {3u, 7u}, {130u, 64u}}) {
        const Image8 image = noise(width, height);
        const Result<Image8> back = decodePng(encodePng(image));
        ASSERT_TRUE(back) << back.error().message;
        EXPECT_EQ(back->width, width);
        EXPECT_EQ(back->height, height);
        EXPECT_EQ(back->rgba, image.rgba);
        EXPECT_EQ(encodePng(image), encodePng(image));
    }
}

TEST(Png, FilesComeBackAndFoldersAreMade)
{
    const auto folder = std::filesystem::path(testing::TempDir()) / "penumbra_png";
    const Image8 image = noise(16, 9);
    ASSERT_TRUE(writePng(folder / "a" / "b.png", image));
    const Result<Image8> back = readPng(folder / "a" / "b.png");
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->rgba, image.rgba);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / "a"), {}), 1);
    EXPECT_FALSE(readPng(folder));
    EXPECT_FALSE(readPng(folder / "missing.png"));
    std::filesystem::remove_all(folder);
}

TEST(Png, DamageIsAnErrorOrAPicture)
{
    const std::vector<std::byte> good = encodePng(noise(8, 8));
    for (std::size_t size = 0; size < good.size() - 12;
         ++size) // the last 12 bytes are the empty IEND
        EXPECT_FALSE(decodePng(std::span(good).first(size))) << size;
    std::mt19937 random(2);
    for (int round = 0; round < 5000; ++round) {
        std::vector<std::byte> bytes = good;
        bytes[random() % bytes.size()] = static_cast<std::byte>(random());
        const Result<Image8> image = decodePng(bytes);
        if (image) {
            ASSERT_EQ(image->rgba.size(), std::size_t{4} * image->width * image->height);
        }
    }
    std::vector<std::byte> huge = good;
    huge[18] = huge[22] = std::byte{0x40}; // 16392 x 16392
    EXPECT_FALSE(decodePng(huge));
    huge[19] = huge[23] = std::byte{0}; // 16384 x 16384: allowed, but the bytes cannot hold it
    const Result<Image8> image = decodePng(huge);
    ASSERT_FALSE(image);
    EXPECT_NE(image.error().message.find("cut"), std::string::npos);
}

TEST(Image, SrgbIsItsOwnInverseAndKeepsBytes)
{
    for (int i = 0; i < 256; ++i)
        EXPECT_NEAR(srgbFromLinear(linearFromSrgb(static_cast<float>(i) / 255)) * 255, i, 1e-3);
    const std::vector<vec3> linear = {vec3(0, 1, 0.2158605f), vec3(-1, 9, NAN)};
    const Image8 image = imageFromLinear(2, 1, linear);
    EXPECT_EQ(image.rgba, (std::vector<std::uint8_t>{0, 255, 128, 255, 0, 255, 0, 255}));
}

TEST(Image, HeatRisesInBrightness)
{
    float before = -1.0f;
    for (int i = 0; i <= 100; ++i) {
        const vec3 c = heatColor(static_cast<float>(i) / 100);
        const float brightness = 0.30f * c.r + 0.59f * c.g + 0.11f * c.b;
        EXPECT_GE(brightness, before - 1e-3f) << i;
        before = brightness;
    }
    EXPECT_EQ(heatColor(0), vec3(0));
    EXPECT_EQ(heatColor(7), vec3(1));
    const Image8 map = heatMap(2, 1, std::vector<float>{NAN, 3.0f}, 3.0f);
    EXPECT_EQ(map.rgba, (std::vector<std::uint8_t>{255, 0, 255, 255, 255, 255, 255, 255}));
}

TEST(Image, SideBySideKeepsThePixels)
{
    const std::vector<Image8> images = {makeImage(2, 1, {1, 2, 3, 4}),
                                        makeImage(1, 3, {5, 6, 7, 8})};
    const Image8 row = sideBySide(images, 1);
    EXPECT_EQ(row.width, 4u);
    EXPECT_EQ(row.height, 3u);
    EXPECT_EQ(row.rgba[4 * 1], 1);
    EXPECT_EQ(row.rgba[4 * 2], 32);
    EXPECT_EQ(row.rgba[4 * (2 * 4 + 3)], 5);
}

} // namespace

} // namespace penumbra
