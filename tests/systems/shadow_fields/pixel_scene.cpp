#include "tests/systems/shadow_fields/pixel_scene.h"

#include "runtime/vk/transfer.h"

#include <glm/gtc/packing.hpp>

namespace penumbra {

DrawnPixels PixelTest::draw(const SceneData& data, const Environment& environment,
                            const FrameConstants& constants, const DrawOptions& options)
{
    if (!m_passes)
        m_passes = take(createFramePasses(device(), {.lights = true, .hiders = true}));
    const FramePasses& passes = *m_passes;
    const FrameTargets targets = take(createFrameTargets(device(), passes, options.extent));
    GpuScene gpu = take(GpuScene::create(device(), data, environment, 2));
    PixelReceivers pixels;
    std::optional<PixelPasses>& pixelPasses = m_pixelPasses[options.rate];
    if (options.rate > 0) {
        if (!pixelPasses)
            pixelPasses = take(createPixelPasses(device(), options.rate));
        pixels.passes = std::move(*pixelPasses); // lent
        pixels.targets = take(createPixelTargets(device(), pixels.passes, gpu, options.extent));
        pixels.targets.capacity = std::min(pixels.targets.capacity, options.capacity);
    }
    FrameRing ring(device());
    for (std::uint32_t i = 0; i < options.frames; ++i) {
        const GpuFrame frame = take(ring.beginFrame());
        recordFrame(frame, passes, gpu, constants,
                    {.kernel = options.kernel, .pixels = options.rate > 0 ? &pixels : nullptr},
                    targets);
        take(ring.endFrame());
    }
    take(ring.waitIdle());

    constexpr auto kRead = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    DrawnPixels drawn;
    drawn.width = options.extent.width;
    drawn.height = options.extent.height;
    drawn.instanceCount = static_cast<std::uint32_t>(data.instances.size());
    drawn.picture = take(readBack(device(), targets.display, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL));
    const std::vector<std::byte> linear = take(readBack(device(), targets.radiance, kRead));
    for (std::size_t i = 0; i < linear.size(); i += 8) {
        std::uint64_t halves = 0;
        std::memcpy(&halves, &linear[i], 8);
        drawn.radiance.push_back(vec3(glm::unpackHalf4x16(halves)));
    }
    drawn.data = data;
    if (options.rate == 0) {
        drawn.vertexRadiance = take(readBackAs<vec4>(device(), gpu.buffers().radiance));
        return drawn;
    }
    pixelPasses = std::move(pixels.passes);
    const PixelTargets& t = pixels.targets;
    drawn.gbuffer = take(readGbuffer(device(), t));
    drawn.slots = take(readBackAs<std::uint32_t>(device(), t.slots));
    drawn.receiverRadiance = take(readBackAs<vec4>(device(), t.receiverRadiance));
    drawn.pixelRadiance = take(readBack(device(), t.radiance, kRead));
    drawn.cull = take(readBackAs<CullResult>(device(), t.cull)).front();
    drawn.counts = take(readBackAs<std::uint32_t>(device(), t.counts));
    drawn.data.receivers = take(readBackAs<ReceiverTexels>(device(), t.receivers));
    drawn.data.bounds = take(readBackAs<ClusterBounds>(device(), t.bounds));
    drawn.data.clusters = take(readBackAs<SceneCluster>(device(), t.clusters));
    drawn.data.clusters.resize(drawn.cull.combineGroups[0]);
    drawn.data.radianceCount = drawn.cull.combineGroups[0] * kClusterReceivers;
    return drawn;
}

} // namespace penumbra
