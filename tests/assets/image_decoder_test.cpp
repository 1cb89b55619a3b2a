// Pictures of a mesh: what is decoded, what is refused, and levels of detail.
#include "assets/image_decoder.h"

#include "runtime/stb_image_write.h"

#include <gtest/gtest.h>

namespace penumbra {
namespace {

void append(void* context, void* data, int size)
{
    auto& out = *static_cast<std::vector<std::byte>*>(context);
    const auto* begin = static_cast<const std::byte*>(data);
    out.insert(out.end(), begin, begin + size);
}

// Noise, which packs badly: a cut takes pixels away, not padding.
std::vector<std::uint8_t> noise(int side)
{
    std::vector<std::uint8_t> rgba;
    std::uint32_t state = 7;
    for (int i = 0; i < 4 * side * side; ++i) {
        state = state * 1664525u + 1013904223u;
        rgba.push_back(static_cast<std::uint8_t>(state >> 24));
    }
    return rgba;
}

MeshImage png(int side)
{
    MeshImage image{ImageType::Png, {}};
    stbi_write_png_to_func(append, &image.bytes, side, side, 4, noise(side).data(), 4 * side);
    return image;
}

MeshImage jpeg(int side)
{
    MeshImage image{ImageType::Jpeg, {}};
    stbi_write_jpg_to_func(append, &image.bytes, side, side, 4, noise(side).data(), 90);
    return image;
}

void expectRefused(const MeshImage& image, const char* text)
{
    const Result<DecodedImage> decoded = decodeImage(image);
    ASSERT_FALSE(decoded) << "not refused: " << text;
    EXPECT_NE(decoded.error().message.find(text), std::string::npos) << decoded.error().message;
}

TEST(ImageDecoder, ReadsPngToTheBitAndJpegNearly)
{
    const Result<DecodedImage> decoded = decodeImage(png(16));
    ASSERT_TRUE(decoded) << decoded.error().message;
    EXPECT_EQ(decoded->width, 16u);
    EXPECT_EQ(decoded->rgba, noise(16));
    const Result<DecodedImage> photo = decodeImage(jpeg(16));
    ASSERT_TRUE(photo) << photo.error().message;
    EXPECT_EQ(photo->rgba.size(), 16u * 16 * 4);
    EXPECT_EQ(photo->rgba[3], 255);
}

TEST(ImageDecoder, RefusesEveryCutFile)
{
    for (const MeshImage& whole : {png(24), jpeg(24)})
        for (std::size_t size = 0; size + 12 < whole.bytes.size(); ++size) // 12: PNG's last chunk
            ASSERT_FALSE(decodeImage(
                {whole.type,
                 {whole.bytes.begin(), whole.bytes.begin() + static_cast<std::ptrdiff_t>(size)}}))
                << size << " of " << whole.bytes.size() << " bytes";
    MeshImage cut = jpeg(24);
    cut.bytes.resize(cut.bytes.size() - 2);
    expectRefused(cut, "24 x 24 pixels: the file is cut off; export it again");
}

// The thumbnail within a cut JPEG has an end of its own.
TEST(ImageDecoder, AThumbnailsEndIsNotThePictures)
{
    MeshImage image = jpeg(24);
    image.bytes.resize(image.bytes.size() - 2);
    const std::byte segment[] = {std::byte{0xff}, std::byte{0xe1}, std::byte{0},
                                 std::byte{4},    std::byte{0xff}, std::byte{0xd9}};
    image.bytes.insert(image.bytes.begin() + 2, std::begin(segment), std::end(segment));
    expectRefused(image, "cut off");
}

// Width and height of a PNG stand at byte 16, big-endian; stb_image does not check their checksum.
TEST(ImageDecoder, RefusesSizesBeforeTheyGetMemory)
{
    const auto withWidth = [](std::uint32_t width) {
        MeshImage image = png(16);
        for (std::size_t i = 0; i < 4; ++i)
            image.bytes[16 + i] = static_cast<std::byte>(width >> (24 - 8 * i));
        return image;
    };
    expectRefused(withWidth(100000), "100000 x 16 pixels, at most 8192 x 8192; scale it down");
    expectRefused(withWidth(0x7fffffff), "no PNG or JPEG that can be read");
    expectRefused(withWidth(0), "no PNG or JPEG that can be read");
    MeshImage tall = withWidth(8192);
    tall.bytes[20 + 2] = std::byte{0x20}; // 8208
    expectRefused(tall, "at most 8192");
    tall.bytes[20 + 2] = std::byte{0x1f}; // 7952: 65 million pixels in a kilobyte
    expectRefused(tall, "cut off");
    EXPECT_FALSE(decodeImage(png(16), 8)); // a device's limit
}

TEST(ImageDecoder, RefusesOtherFiles)
{
    expectRefused({ImageType::Png, std::vector<std::byte>(100)}, "no PNG or JPEG");
    expectRefused({ImageType::Png, {}}, "no PNG or JPEG");
}

TEST(MipChain, KeepsTheMeanOfLight)
{
    // Black and white columns: half the light, which is 188 of 255 in sRGB.
    DecodedImage image{4, 2, {}};
    for (int i = 0; i < 8; ++i)
        image.rgba.insert(image.rgba.end(), 4, i % 2 == 0 ? 0 : 255);
    for (std::size_t i = 3; i < image.rgba.size(); i += 4)
        image.rgba[i] = 255;
    const MipChain chain = makeMipChain(image);
    EXPECT_EQ(chain.levels, 3u);
    ASSERT_EQ(chain.rgba.size(), 4u * (8 + 2 + 1));
    for (std::size_t i = 32; i < chain.rgba.size(); i += 4)
        EXPECT_EQ(chain.rgba[i], 188);
}

TEST(MipChain, OddSidesWeightWhatTheyCover)
{
    // Three pixels become one: each counts a third.
    const MipChain three = makeMipChain({3, 1, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255}});
    EXPECT_EQ(three.levels, 2u);
    ASSERT_EQ(three.rgba.size(), 16u);
    EXPECT_EQ(three.rgba[12], 156); // a third of full light
    EXPECT_EQ(three.rgba[13], 156);
    EXPECT_EQ(three.rgba[14], 156);
    // Five become two, of 2.5 each: the middle one counts for both.
    const std::vector<std::uint8_t> grey(20, 255);
    const MipChain five = makeMipChain({5, 1, grey});
    EXPECT_EQ(five.levels, 3u);
    for (const std::uint8_t value : five.rgba)
        EXPECT_EQ(value, 255);
}

TEST(MipChain, TransparentPixelsDoNotBleed)
{
    const MipChain chain = makeMipChain({2, 1, {200, 100, 50, 255, 0, 255, 0, 0}});
    const std::vector<std::uint8_t> last(chain.rgba.end() - 4, chain.rgba.end());
    EXPECT_EQ(last, (std::vector<std::uint8_t>{200, 100, 50, 128}));
}

} // namespace
} // namespace penumbra
