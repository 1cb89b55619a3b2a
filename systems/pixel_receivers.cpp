#include "systems/pixel_receivers.h"

#include "runtime/vk/barriers.h"
#include "runtime/vk/gpu_zone.h"
#include "shaders/shared/pixel.h"

#include <cstddef>

namespace penumbra {

namespace {

constexpr VkFormat kWords = VK_FORMAT_R32G32B32A32_UINT;
constexpr VkFormat kWord = VK_FORMAT_R32_UINT;

PixelPush pushOf(const PixelTargets& targets)
{
    return {targets.extent.width, targets.extent.height, targets.capacity};
}

VkRenderingAttachmentInfo attachment(const Image& image, VkImageLayout layout,
                                     VkAttachmentLoadOp load, VkClearValue clear)
{
    return {.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
            .imageView = image.view,
            .imageLayout = layout,
            .loadOp = load,
            .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
            .clearValue = clear};
}

void beginGbuffer(VkCommandBuffer cmd, const PixelTargets& targets, const Image& depth)
{
    constexpr auto kLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    constexpr auto kAny = VK_ATTACHMENT_LOAD_OP_DONT_CARE, kClear = VK_ATTACHMENT_LOAD_OP_CLEAR;
    const VkRenderingAttachmentInfo colors[] = {
        attachment(targets.geometry, kLayout, kAny, {}),
        attachment(targets.selfVisibility, kLayout, kAny, {}),
        attachment(targets.instance, kLayout, kClear,
                   {.color = {.uint32 = {kBackground, 0, 0, 0}}})};
    const VkRenderingAttachmentInfo depthTarget = attachment(
        depth, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, kClear, {.depthStencil = {.depth = 1}});
    const VkRenderingInfo info{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                               .renderArea = {.extent = targets.extent},
                               .layerCount = 1,
                               .colorAttachmentCount = std::size(colors),
                               .pColorAttachments = colors,
                               .pDepthAttachment = &depthTarget};
    vkCmdBeginRendering(cmd, &info);
    setViewport(cmd, targets.extent);
}

Result<Pipeline> createGbufferPass(const Device& device)
{
    constexpr auto kPerInstance = VK_VERTEX_INPUT_RATE_INSTANCE;
    constexpr auto kVec4 = VK_FORMAT_R32G32B32A32_SFLOAT;
    constexpr auto kBytes = VK_FORMAT_R8G8B8A8_UNORM;
    constexpr std::uint32_t kRow0 = offsetof(GpuInstance, worldFromObject0);
    constexpr std::uint32_t kNormal = offsetof(ReceiverTexels, geometry) + 12;
    constexpr std::uint32_t kSelf = offsetof(ReceiverTexels, selfVisibility);
    return createGraphicsPipeline(
        device, {.name = "gbuffer",
                 .vertexShader = "gbuffer.vert",
                 .fragmentShader = "gbuffer.frag",
                 .bindings = {sceneBindings().begin(), sceneBindings().end()},
                 .vertexBindings = {{0, sizeof(ReceiverTexels), VK_VERTEX_INPUT_RATE_VERTEX},
                                    {1, sizeof(GpuInstance), kPerInstance}},
                 .vertexAttributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0},
                                      {1, 0, kWord, kNormal},
                                      {2, 1, kVec4, kRow0},
                                      {3, 1, kVec4, kRow0 + 16},
                                      {4, 1, kVec4, kRow0 + 32},
                                      {5, 0, kBytes, kSelf},
                                      {6, 0, kBytes, kSelf + 4},
                                      {7, 0, kBytes, kSelf + 8},
                                      {8, 0, kBytes, kSelf + 12}},
                 .colorFormats = {kWords, kWords, kWord},
                 .depthFormat = VK_FORMAT_D32_SFLOAT});
}

} // namespace

Result<PixelPasses> createPixelPasses(const Device& device, std::uint32_t rate)
{
    PENUMBRA_ASSERT(rate == 1 || rate == 2, "rate {} is 1 or 2", rate);
    constexpr auto kImage = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    constexpr auto kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    constexpr auto kTexels = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
    const std::vector<Binding> bindings = {{0, kImage},
                                           {1, kImage},
                                           {2, kImage},
                                           {3, kStorage},
                                           {4, kStorage},
                                           {5, kStorage},
                                           {6, kStorage},
                                           {7, kStorage},
                                           {8, kStorage},
                                           {9, kTexels},
                                           {10, kTexels},
                                           {11, kTexels},
                                           {12, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}};
    PixelPasses passes;
    passes.rate = rate;
    Result<Pipeline> gbuffer = createGbufferPass(device);
    if (!gbuffer)
        return gbuffer.error();
    passes.gbuffer = std::move(*gbuffer);
    const std::pair<Pipeline&, const char*> compute[] = {{passes.clusters, "pixel_clusters.comp"},
                                                         {passes.bounds, "pixel_bounds.comp"},
                                                         {passes.resolve, "pixel_resolve.comp"}};
    for (const auto& [pipeline, shader] : compute) {
        Result<Pipeline> made = createComputePipeline(device, {.shader = shader,
                                                               .bindings = bindings,
                                                               .pushBytes = sizeof(PixelPush),
                                                               .constants = {rate}});
        if (!made)
            return made.error();
        pipeline = std::move(*made);
    }
    return passes;
}

void recordGbuffer(const GpuFrame& gpu, const PixelReceivers& pixels, const GpuScene& scene,
                   const Image& depth)
{
    const GpuZone zone(gpu.cmd, "gbuffer");
    const PixelTargets& targets = pixels.targets;
    const Image* const colors[] = {&targets.geometry, &targets.selfVisibility, &targets.instance};
    for (const Image* image : colors)
        transitionImage(gpu.cmd, image->handle, image->aspect, kUndefinedImage, kColorTarget);
    transitionImage(gpu.cmd, depth.handle, depth.aspect, kUndefinedImage, kDepthTarget);
    beginGbuffer(gpu.cmd, targets, depth);
    bind(gpu.cmd, pixels.passes.gbuffer, scene.slot(gpu.slot).set, nullptr, 0);
    const GpuSceneBuffers& b = scene.buffers();
    vkCmdBindIndexBuffer(gpu.cmd, b.indices.handle, 0, VK_INDEX_TYPE_UINT32);
    for (std::size_t i = 0; i < scene.data().instances.size(); ++i) {
        const MeshRange& mesh = scene.data().meshes[scene.data().instances[i].mesh];
        const VkBuffer buffers[] = {b.receivers.handle, b.instances.handle};
        const VkDeviceSize offsets[] = {mesh.firstReceiver * sizeof(ReceiverTexels), 0};
        vkCmdBindVertexBuffers(gpu.cmd, 0, 2, buffers, offsets);
        for (std::uint32_t d = scene.data().firstDraw[i]; d < scene.data().firstDraw[i + 1]; ++d)
            vkCmdDrawIndexedIndirect(gpu.cmd, b.drawCommands.handle,
                                     d * sizeof(VkDrawIndexedIndirectCommand), 1, 0);
    }
    vkCmdEndRendering(gpu.cmd);
    for (const Image* image : colors)
        transitionImage(gpu.cmd, image->handle, image->aspect, kColorTarget, kShaderRead);
}

void recordPixelClusters(const GpuFrame& gpu, const PixelReceivers& pixels)
{
    const GpuZone zone(gpu.cmd, "pixel_clusters");
    const PixelTargets& targets = pixels.targets;
    const CullResult nothing{{0, 1, 1}, {0, 1, 1}, 0, 0};
    vkCmdUpdateBuffer(gpu.cmd, targets.cull.handle, 0, sizeof(nothing), &nothing);
    transferToCompute(gpu.cmd);
    bindAndPush(gpu.cmd, pixels.passes.clusters, targets.set, pushOf(targets));
    vkCmdDispatch(gpu.cmd, groupCount(targets.extent.width, kPixelBlock),
                  groupCount(targets.extent.height, kPixelBlock), 1);
    computeToIndirect(gpu.cmd);
}

void recordPixelBounds(const GpuFrame& gpu, const PixelReceivers& pixels)
{
    static_assert(kPixelBoundsGroup == kSortGroup, "both are dispatched by CullResult::sortGroups");
    const GpuZone zone(gpu.cmd, "pixel_bounds");
    bindAndPush(gpu.cmd, pixels.passes.bounds, pixels.targets.set, pushOf(pixels.targets));
    vkCmdDispatchIndirect(gpu.cmd, pixels.targets.cull.handle, offsetof(CullResult, sortGroups));
    computeToIndirect(gpu.cmd);
}

void recordPixelResolve(const GpuFrame& gpu, const PixelReceivers& pixels)
{
    const GpuZone zone(gpu.cmd, "pixel_resolve");
    const PixelTargets& targets = pixels.targets;
    computeToCompute(gpu.cmd); // the radiance of pass combine
    transitionImage(gpu.cmd, targets.radiance.handle, targets.radiance.aspect, kUndefinedImage,
                    kStorageImage);
    bindAndPush(gpu.cmd, pixels.passes.resolve, targets.set, pushOf(targets));
    vkCmdDispatch(gpu.cmd, groupCount(targets.extent.width, 16),
                  groupCount(targets.extent.height, 16), 1);
    transitionImage(gpu.cmd, targets.radiance.handle, targets.radiance.aspect, kStorageImage,
                    kShaderRead);
}

} // namespace penumbra
