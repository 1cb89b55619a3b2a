// A triangle through dynamic rendering: which way is up, which side is front, depth and blending.
#include "runtime/vk/barriers.h"
#include "runtime/vk/pipeline.h"
#include "runtime/vk/transfer.h"
#include "tests/support/gpu_fixture.h"

#include <array>

namespace penumbra {
namespace {

struct TrianglePush {
    std::array<float, 4> color; // linear RGBA
    float depth;
};
using Pixel = std::array<std::uint8_t, 4>;
using Corners = std::array<std::array<float, 2>, 3>; // clip space, Y up

constexpr VkExtent2D kSize = {16, 16};
// Counter-clockwise, covers the upper left half of the target.
constexpr Corners kUpperLeft = {{{-1, 1}, {-1, -1}, {1, 1}}};

class Graphics : public GpuTest {
protected:
    void SetUp() override
    {
        GpuTest::SetUp();
        m_color.emplace(
            take(createImage(device(), {.name = "color",
                                        .extent = kSize,
                                        .format = VK_FORMAT_R8G8B8A8_UNORM,
                                        .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT})));
        m_depth.emplace(
            take(createImage(device(), {.name = "depth",
                                        .extent = kSize,
                                        .format = VK_FORMAT_D32_SFLOAT,
                                        .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT})));
    }
    void TearDown() override
    {
        m_color.reset();
        m_depth.reset();
        GpuTest::TearDown();
    }

    Pipeline createPipeline(const GraphicsDesc& changes)
    {
        GraphicsDesc desc = changes;
        desc.name = "triangle";
        desc.vertexShader = "triangle.vert";
        desc.fragmentShader = "triangle.frag";
        desc.pushBytes = sizeof(TrianglePush);
        desc.vertexBindings = {{0, sizeof(float) * 2, VK_VERTEX_INPUT_RATE_VERTEX}};
        desc.vertexAttributes = {{0, 0, VK_FORMAT_R32G32_SFLOAT, 0}};
        desc.colorFormats = {m_color->format};
        desc.depthFormat = m_depth->format;
        return take(createGraphicsPipeline(device(), desc));
    }

    // Clears to transparent black and depth 1, draws in order, returns the pixels [kSize].
    std::vector<Pixel> draw(const Pipeline& pipeline, const Corners& corners,
                            std::initializer_list<TrianglePush> triangles)
    {
        const Buffer vertices = take(createBufferWith(
            device(), {.name = "corners", .usage = VK_BUFFER_USAGE_VERTEX_BUFFER_BIT},
            std::as_bytes(std::span(corners))));
        take(submitAndWait(device(), [&](VkCommandBuffer cmd) {
            transitionImage(cmd, m_color->handle, m_color->aspect, kUndefinedImage, kColorTarget);
            transitionImage(cmd, m_depth->handle, m_depth->aspect, kUndefinedImage, kDepthTarget);
            VkRenderingAttachmentInfo color = {VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
            color.imageView = m_color->view;
            color.imageLayout = kColorTarget.layout;
            color.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
            color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
            VkRenderingAttachmentInfo depth = color;
            depth.imageView = m_depth->view;
            depth.imageLayout = kDepthTarget.layout;
            depth.clearValue.depthStencil.depth = 1;
            VkRenderingInfo rendering = {VK_STRUCTURE_TYPE_RENDERING_INFO};
            rendering.renderArea.extent = kSize;
            rendering.layerCount = 1;
            rendering.colorAttachmentCount = 1;
            rendering.pColorAttachments = &color;
            rendering.pDepthAttachment = &depth;
            vkCmdBeginRendering(cmd, &rendering);
            setViewport(cmd, kSize);
            const VkBuffer buffer = vertices.handle;
            const VkDeviceSize offset = 0;
            vkCmdBindVertexBuffers(cmd, 0, 1, &buffer, &offset);
            for (const TrianglePush& push : triangles) {
                bindAndPush(cmd, pipeline, push);
                vkCmdDraw(cmd, 3, 1, 0, 0);
            }
            vkCmdEndRendering(cmd);
        }));
        const std::vector<std::byte> bytes =
            take(readBack(device(), *m_color, kColorTarget.layout));
        std::vector<Pixel> pixels(kSize.width * kSize.height);
        std::memcpy(pixels.data(), bytes.data(), bytes.size());
        return pixels;
    }

    static Pixel at(const std::vector<Pixel>& pixels, std::uint32_t x, std::uint32_t y)
    {
        return pixels[y * kSize.width + x]; // row 0 is the top
    }

    std::optional<Image> m_color;
    std::optional<Image> m_depth;
};

constexpr TrianglePush kRedFar = {{1, 0, 0, 1}, 0.75f};
constexpr TrianglePush kGreenNear = {{0, 1, 0, 1}, 0.25f};
constexpr Pixel kNothing = {0, 0, 0, 0};
constexpr Pixel kRed = {255, 0, 0, 255};
constexpr Pixel kGreen = {0, 255, 0, 255};

TEST_F(Graphics, ClipSpaceUpIsTheTopRowAndCounterClockwiseIsFront)
{
    const Pipeline pipeline = createPipeline({});
    const std::vector<Pixel> front = draw(pipeline, kUpperLeft, {kRedFar});
    EXPECT_EQ(at(front, 2, 2), kRed);
    EXPECT_EQ(at(front, 13, 13), kNothing);

    const Corners reversed = {kUpperLeft[0], kUpperLeft[2], kUpperLeft[1]};
    EXPECT_EQ(at(draw(pipeline, reversed, {kRedFar}), 2, 2), kNothing);
    const Pipeline twoSided = createPipeline({.cull = VK_CULL_MODE_NONE});
    EXPECT_EQ(at(draw(twoSided, reversed, {kRedFar}), 2, 2), kRed);
}

TEST_F(Graphics, NearerWinsUnlessDepthIsOff)
{
    const Pipeline tested = createPipeline({});
    EXPECT_EQ(at(draw(tested, kUpperLeft, {kGreenNear, kRedFar}), 2, 2), kGreen);
    EXPECT_EQ(at(draw(tested, kUpperLeft, {kRedFar, kGreenNear}), 2, 2), kGreen);
    const Pipeline untested = createPipeline({.depthTest = false});
    EXPECT_EQ(at(draw(untested, kUpperLeft, {kGreenNear, kRedFar}), 2, 2), kRed);
    const Pipeline unwritten = createPipeline({.depthWrite = false});
    EXPECT_EQ(at(draw(unwritten, kUpperLeft, {kGreenNear, kRedFar}), 2, 2), kRed);
}

TEST_F(Graphics, AlphaBlendIsSourceOver)
{
    const Pipeline pipeline = createPipeline({.blend = Blend::Alpha});
    const TrianglePush halfGreen = {{0, 1, 0, 0.5f}, 0.25f};
    const Pixel mixed = at(draw(pipeline, kUpperLeft, {kRedFar, halfGreen}), 2, 2);
    EXPECT_NEAR(mixed[0], 128, 1);
    EXPECT_NEAR(mixed[1], 128, 1);
    EXPECT_EQ(mixed[3], 255);
}

} // namespace
} // namespace penumbra
