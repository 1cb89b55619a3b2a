#include "demo/renderer.h"

#include "runtime/vk/barriers.h"
#include "runtime/vk/transfer.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <glm/gtc/packing.hpp>

namespace penumbra {

Result<std::unique_ptr<Renderer>> Renderer::create(const Device& device, DemoScene& scene,
                                                   VkExtent2D extent, std::uint32_t beams)
{
    std::unique_ptr<Renderer> renderer(new Renderer(device, scene, beams));
    Result<SceneData> data = extractScene(scene.world, scene.assets);
    if (!data)
        return scene.path.empty() ? data.error() : fail(data.error(), scene.path.string());
    Result<FramePasses> passes = createFramePasses(device, sceneFeatures(*data));
    if (!passes)
        return passes.error();
    renderer->m_passes = std::move(*passes);
    Result<GpuScene> gpuScene =
        GpuScene::create(device, std::move(*data), {}, renderer->m_ring.framesInFlight(), beams);
    if (!gpuScene)
        return gpuScene.error();
    renderer->m_scene = std::move(*gpuScene);
    SceneChanges first;
    std::as_const(scene.world)
        .query<const EnvironmentLight>()
        .each([&](const EnvironmentLight& light) { first.environments.push_back(light); });
    first.relit = true;
    if (Result<void> lit = renderer->apply(first); !lit)
        return lit.error();
    if (Result<void> sized = renderer->resize(extent); !sized)
        return sized.error();
    return renderer;
}

Result<void> Renderer::apply(const SceneChanges& changes)
{
    applyChanges(changes, m_scene);
    Result<void> done;
    if (changes.relit) {
        m_lighting.set(changes.environments);
        m_scene.setBeams(m_lighting.beams());
        done = m_scene.setBackground(m_lighting.background());
    }
    if (changes.relit || !changes.materials.empty()) {
        const std::vector<SceneInstance>& instances = m_scene.data().instances;
        const bool mirrors =
            std::any_of(instances.begin(), instances.end(), [](const SceneInstance& instance) {
                return mirrorsSky(instance.material.glossFraction, instance.material.glossExponent);
            });
        if (mirrors && (changes.relit || !m_scene.mirrors()))
            m_scene.setSkyLobes(m_lighting.lobes());
        else if (!mirrors && m_scene.mirrors())
            m_scene.setSkyLobes({});
    }
    return done;
}

FrameConstants Renderer::constants(const View& view) const
{
    return frameConstants(view, m_lighting.light());
}

Result<GpuFrame> Renderer::beginFrame(const View& view, Kernel kernel, bool combine)
{
    Result<GpuFrame> frame = m_ring.beginFrame();
    if (frame)
        recordFrame(*frame, m_passes, m_scene, constants(view),
                    {kernel, combine, m_exposure, m_surfaces, pixels()}, m_targets);
    return frame;
}

Result<void> Renderer::endFrame(std::span<const VkSemaphoreSubmitInfo> waits,
                                std::span<const VkSemaphoreSubmitInfo> signals)
{
    return m_ring.endFrame(waits, signals);
}

Result<void> Renderer::drawFrame(const View& view, Kernel kernel, bool combine)
{
    Result<GpuFrame> frame = beginFrame(view, kernel, combine);
    if (!frame)
        return frame.error();
    m_slot = frame->slot;
    if (Result<void> ended = endFrame(); !ended)
        return ended;
    return m_ring.waitIdle();
}

Result<std::map<std::string, double>> Renderer::timePasses(Kernel kernel)
{
    using Clock = std::chrono::steady_clock;
    const bool onCpu = m_device.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    std::map<std::string, double> milliseconds;
    Result<void> failed;
    const auto time = [&](const char* name, auto&& record) {
        ZoneTimer timer(m_device, onCpu ? 0 : 1);
        const auto start = Clock::now();
        Result<void> done = submitAndWait(m_device, [&](VkCommandBuffer cmd) {
            timer.begin(cmd);
            record(GpuFrame{.cmd = cmd, .slot = m_slot});
            timer.end();
        });
        const std::chrono::duration<double, std::milli> elapsed = Clock::now() - start;
        const std::vector<ZoneTime> zones = timer.read();
        milliseconds[name] = zones.empty() ? elapsed.count() : zones.front().milliseconds;
        if (!done)
            failed = done;
    };
    time("instance_update",
         [&](const GpuFrame& gpu) { recordInstanceUpdate(gpu, m_passes, m_scene); });
    time("cluster_cull", [&](const GpuFrame& gpu) { recordClusterCull(gpu, m_passes, m_scene); });
    if (m_pixels) {
        time("gbuffer", [&](const GpuFrame& gpu) {
            computeToGraphics(gpu.cmd); // the instances of the submission before
            recordGbuffer(gpu, *m_pixels, m_scene, m_targets.depth);
        });
        time("pixel_clusters", [&](const GpuFrame& gpu) { recordPixelClusters(gpu, *m_pixels); });
        time("pixel_bounds", [&](const GpuFrame& gpu) { recordPixelBounds(gpu, *m_pixels); });
    }
    const auto receivers = [&](const GpuFrame& gpu) {
        return receiverClusters(gpu, m_scene, pixels());
    };
    time("entity_sort",
         [&](const GpuFrame& gpu) { recordEntitySort(gpu, m_passes, receivers(gpu)); });
    time("combine", [&](const GpuFrame& gpu) {
        recordCombine(gpu, m_passes, receivers(gpu), kernel, m_scene.mirrors());
    });
    if (!m_scene.beams().empty()) {
        time("beam_maps", [&](const GpuFrame& gpu) { recordBeamMaps(gpu, m_passes, m_scene); });
        time("beams", [&](const GpuFrame& gpu) { recordBeams(gpu, m_passes, receivers(gpu)); });
    }
    if (m_pixels)
        time("pixel_resolve", [&](const GpuFrame& gpu) { recordPixelResolve(gpu, *m_pixels); });
    time("raster", [&](const GpuFrame& gpu) {
        computeToGraphics(gpu.cmd); // the radiance of the submission before
        recordRaster(gpu, m_passes, m_scene, m_targets, m_surfaces, pixels());
    });
    time("post", [&](const GpuFrame& gpu) { recordPost(gpu, m_passes, m_targets, m_exposure); });
    if (!failed)
        return failed.error();
    return milliseconds;
}

Result<void> Renderer::resize(VkExtent2D extent)
{
    Result<FrameTargets> targets = createFrameTargets(m_device, m_passes, extent);
    if (!targets)
        return targets.error();
    m_ring.retire(std::exchange(m_targets, std::move(*targets)));
    return m_pixels ? createPixels() : Result<void>{};
}

Result<void> Renderer::setReceivers(ReceiverKind kind)
{
    m_receivers = kind;
    if (kind != ReceiverKind::Vertex)
        return createPixels();
    if (m_pixels)
        m_ring.retire(std::exchange(m_pixels, std::nullopt));
    return {};
}

Result<void> Renderer::createPixels()
{
    const std::uint32_t rate = m_receivers == ReceiverKind::Pixel ? 1 : 2;
    PixelReceivers pixels;
    if (m_pixels && m_pixels->passes.rate == rate) {
        pixels.passes = std::move(m_pixels->passes);
    } else {
        Result<PixelPasses> passes = createPixelPasses(m_device, rate);
        if (!passes)
            return passes.error();
        pixels.passes = std::move(*passes);
    }
    Result<PixelTargets> targets = createPixelTargets(m_device, pixels.passes, m_scene, extent());
    if (!targets)
        return targets.error();
    pixels.targets = std::move(*targets);
    if (m_pixels)
        m_ring.retire(std::exchange(m_pixels, std::nullopt));
    m_pixels = std::move(pixels);
    return {};
}

Result<Image8> Renderer::capture() const
{
    Result<std::vector<std::byte>> pixels =
        readBack(m_device, m_targets.display, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    if (!pixels)
        return pixels.error();
    Image8 image = makeImage(extent().width, extent().height);
    std::memcpy(image.rgba.data(), pixels->data(), image.rgba.size());
    return image;
}

Result<std::vector<vec3>> Renderer::linearPicture() const
{
    Result<std::vector<std::byte>> bytes =
        readBack(m_device, m_targets.radiance, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    if (!bytes)
        return bytes.error();
    std::vector<std::uint64_t> pixels(bytes->size() / sizeof(std::uint64_t));
    std::memcpy(pixels.data(), bytes->data(), bytes->size());
    std::vector<vec3> picture;
    for (const std::uint64_t pixel : pixels)
        picture.push_back(vec3(glm::unpackHalf4x16(pixel)));
    return picture;
}

Result<std::vector<vec4>> Renderer::radiance() const
{
    if (!m_pixels)
        return readBackAs<vec4>(m_device, m_scene.buffers().radiance);
    Result<std::vector<std::byte>> bytes =
        readBack(m_device, m_pixels->targets.radiance, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    if (!bytes)
        return bytes.error();
    std::vector<vec4> radiance(radianceCount());
    for (std::size_t i = 0; i < radiance.size(); ++i) {
        std::uint64_t halves = 0;
        std::memcpy(&halves, bytes->data() + sizeof(halves) * i, sizeof(halves));
        radiance[i] = glm::unpackHalf4x16(halves);
    }
    return radiance;
}

std::size_t Renderer::radianceCount() const
{
    return m_pixels ? std::size_t{extent().width} * extent().height : m_scene.data().radianceCount;
}

Result<CullResult> Renderer::cullResult() const
{
    Result<std::vector<CullResult>> result = readBackAs<CullResult>(
        m_device, m_pixels ? m_pixels->targets.cull : m_scene.buffers().cull);
    if (!result)
        return result.error();
    return result->front();
}

Result<void> Renderer::setRadiance(std::span<const vec4> radiance)
{
    if (!m_pixels)
        return upload(m_device, m_scene.buffers().radiance, std::as_bytes(radiance));
    std::vector<std::uint64_t> halves;
    for (const vec4& r : radiance)
        halves.push_back(glm::packHalf4x16(r));
    return upload(m_device, m_pixels->targets.radiance, std::as_bytes(std::span(halves)),
                  VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

} // namespace penumbra
