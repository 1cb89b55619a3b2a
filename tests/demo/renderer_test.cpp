// The demo's renderer: what receives light changes between frames, and so does the size.
#include "demo/renderer.h"

#include "tests/support/gpu_fixture.h"

namespace penumbra {
namespace {

class RendererTest : public GpuTest {};

TEST_F(RendererTest, ReceiversAndSizeChangeBetweenFrames)
{
    const std::filesystem::path assets =
        std::filesystem::path(PENUMBRA_DEMO).parent_path().parent_path() / "assets";
    const std::unique_ptr<DemoScene> scene = take(loadScene("coarse", {.assets = assets}));
    const std::unique_ptr<Renderer> renderer = take(Renderer::create(device(), *scene, {96, 64}));
    const View view = viewOf(scene->camera, 1.5f);
    const auto draw = [&](ReceiverKind kind, VkExtent2D extent) {
        if (extent.width != renderer->extent().width)
            take(renderer->resize(extent));
        if (kind != renderer->receivers())
            take(renderer->setReceivers(kind));
        take(renderer->drawFrame(view, Kernel::Exact));
        EXPECT_EQ(renderer->radianceCount(), take(renderer->radiance()).size());
        EXPECT_GT(take(renderer->cullResult()).combineGroups[0], 0u);
        const Image8 image = take(renderer->capture());
        EXPECT_EQ(image.width, extent.width);
        EXPECT_EQ(image.height, extent.height);
        return image.rgba;
    };
    const auto vertices = draw(ReceiverKind::Vertex, {96, 64});
    const auto pixels = draw(ReceiverKind::Pixel, {96, 64});
    EXPECT_NE(pixels, vertices); // the floor has shadows
    draw(ReceiverKind::Pixel, {81, 54});
    draw(ReceiverKind::PixelHalf, {81, 54});
    draw(ReceiverKind::PixelHalf, {150, 100});
    draw(ReceiverKind::Vertex, {150, 100});
    EXPECT_EQ(draw(ReceiverKind::Vertex, {96, 64}), vertices);
    EXPECT_EQ(draw(ReceiverKind::Pixel, {96, 64}), pixels);

    // Radiance from elsewhere is shown as it is.
    take(renderer->setRadiance(std::vector<vec4>(renderer->radianceCount(), vec4(0.25f))));
    take(renderer->drawFrame(view, Kernel::Exact, false));
    EXPECT_EQ(take(renderer->radiance()), std::vector<vec4>(96 * 64, vec4(0.25f)));
}

} // namespace
} // namespace penumbra
