#include "runtime/vk/transfer.h"

#include "tests/support/gpu_fixture.h"

namespace penumbra {
namespace {

using Transfer = GpuTest;

std::vector<std::byte> ramp(std::size_t count)
{
    std::vector<std::byte> bytes(count);
    for (std::size_t i = 0; i < count; ++i)
        bytes[i] = static_cast<std::byte>(i * 7 + i / 256);
    return bytes;
}

TEST_F(Transfer, BufferBytesComeBackAsTheyWent)
{
    for (const std::size_t count : {1u, 3u, 4u, 1000u, 1u << 20}) { // odd sizes too
        const std::vector<std::byte> bytes = ramp(count);
        const Buffer buffer = take(createBufferWith(device(), {.name = "ramp"}, bytes));
        EXPECT_EQ(buffer.bytes, count);
        EXPECT_EQ(buffer.mapped, nullptr);
        EXPECT_EQ(take(readBack(device(), buffer)), bytes);
    }
}

TEST_F(Transfer, PartsOfABuffer)
{
    const std::vector<std::byte> bytes = ramp(100);
    const Buffer buffer = take(createBufferWith(device(), {.name = "parts"}, bytes));
    const std::vector<std::byte> patch(10, std::byte{255});
    take(upload(device(), buffer, patch, 33));
    EXPECT_EQ(take(readBack(device(), buffer, 33, 10)), patch);
    EXPECT_EQ(take(readBack(device(), buffer, 43)),
              std::vector<std::byte>(bytes.begin() + 43, bytes.end()));
    EXPECT_TRUE(take(readBack(device(), buffer, 100)).empty());
    take(upload(device(), buffer, {}, 100)); // nothing, nowhere
}

TEST_F(Transfer, MappedBuffersAreSeenByTheGpuAndBack)
{
    const Buffer source =
        take(createBuffer(device(), {.name = "source", .bytes = 4, .memory = MemoryKind::Upload}));
    const Buffer target = take(
        createBuffer(device(), {.name = "target", .bytes = 4, .memory = MemoryKind::Readback}));
    const std::uint32_t value = 0xdecaf;
    std::memcpy(source.mapped, &value, 4);
    take(submitAndWait(device(), [&](VkCommandBuffer cmd) {
        const VkBufferCopy all = {0, 0, 4};
        vkCmdCopyBuffer(cmd, source.handle, target.handle, 1, &all);
    }));
    std::uint32_t got = 0;
    std::memcpy(&got, target.mapped, 4);
    EXPECT_EQ(got, value);
}

TEST_F(Transfer, ImagePixelsComeBackAsTheyWent)
{
    const Image image = take(createImage(device(), {.name = "picture",
                                                    .extent = {17, 5},
                                                    .format = VK_FORMAT_R8G8B8A8_UNORM,
                                                    .usage = VK_IMAGE_USAGE_SAMPLED_BIT}));
    const std::vector<std::byte> pixels = ramp(17 * 5 * 4);
    take(upload(device(), image, pixels, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL));
    for (int i = 0; i < 2; ++i) // the layout is as it was
        EXPECT_EQ(take(readBack(device(), image, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL)),
                  pixels);
}

TEST_F(Transfer, LimitsAreErrorsThatNameTheObject)
{
    const Result<Buffer> huge =
        createBuffer(device(), {.name = "fields", .bytes = VkDeviceSize{1} << 60});
    ASSERT_FALSE(huge);
    EXPECT_NE(huge.error().message.find("'fields'"), std::string::npos) << huge.error().message;

    const VkDeviceSize tooMany =
        VkDeviceSize{device().properties.limits.maxTexelBufferElements} + 1;
    if (tooMany < (VkDeviceSize{1} << 31)) { // larger ones run into the limit of all buffers
        const Result<Buffer> texels = createBuffer(
            device(), {.name = "texels", .bytes = tooMany, .texelFormat = VK_FORMAT_R8_UINT});
        ASSERT_FALSE(texels);
        EXPECT_NE(texels.error().message.find("texels, the device allows"), std::string::npos);
    }

    const Result<Image> wide = createImage(device(), {.name = "wide",
                                                      .extent = {1u << 30, 1},
                                                      .format = VK_FORMAT_R8G8B8A8_UNORM,
                                                      .usage = VK_IMAGE_USAGE_SAMPLED_BIT});
    ASSERT_FALSE(wide);
    EXPECT_NE(wide.error().message.find("1073741824x1"), std::string::npos);

    const Result<Image> odd = createImage(device(), {.name = "odd",
                                                     .extent = {4, 4},
                                                     .format = VK_FORMAT_D32_SFLOAT,
                                                     .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT});
    EXPECT_FALSE(odd);
}

} // namespace
} // namespace penumbra
