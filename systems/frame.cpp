#include "systems/frame.h"

#include "runtime/vk/barriers.h"
#include "runtime/vk/gpu_zone.h"
#include "systems/draw_instances.h"

#include <algorithm>
#include <bit>
#include <cstddef>

namespace penumbra {

namespace {

constexpr VkFormat kRadianceFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;
constexpr VkFormat kDisplayFormat = VK_FORMAT_R8G8B8A8_UNORM;

// Receivers per invocation of combine_exact. An occluder's constants are loaded once for all of
// them, which decides on lavapipe (findings section 1, kernel J); a GPU has registers for two.
std::uint32_t receiversPerInvocation(const Device& device)
{
    return device.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU ? 4 : 2;
}

void beginRendering(VkCommandBuffer cmd, const FrameTargets& targets)
{
    const VkRenderingAttachmentInfo color{
        .sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
        .imageView = targets.radiance.view,
        .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
        .loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE, // pass background fills what pass raster leaves
        .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
    const VkRenderingAttachmentInfo depth{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                          .imageView = targets.depth.view,
                                          .imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                                          .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                          .storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                          .clearValue = {.depthStencil = {.depth = 1}}};
    const VkRenderingInfo info{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                               .renderArea = {.extent = targets.radiance.extent},
                               .layerCount = 1,
                               .colorAttachmentCount = 1,
                               .pColorAttachments = &color,
                               .pDepthAttachment = &depth};
    vkCmdBeginRendering(cmd, &info);
    setViewport(cmd, targets.radiance.extent);
}

void dispatchCovering(VkCommandBuffer cmd, std::uint32_t items, std::uint32_t groupSize)
{
    vkCmdDispatch(cmd, groupCount(items, groupSize), 1, 1);
}

} // namespace

void recordFrame(const GpuFrame& gpu, const FramePasses& passes, GpuScene& scene,
                 const FrameConstants& constants, const FrameOptions& options,
                 const FrameTargets& targets)
{
    FrameConstants frame = constants;
    frame.literal = options.kernel == Kernel::Literal ? 1 : 0;
    scene.writeFrame(gpu.slot, frame);
    recordInstanceUpdate(gpu, passes, scene);
    recordClusterCull(gpu, passes, scene);
    if (options.pixels) {
        computeToGraphics(gpu.cmd);
        recordGbuffer(gpu, *options.pixels, scene, targets.depth);
        recordPixelClusters(gpu, *options.pixels);
        recordPixelBounds(gpu, *options.pixels);
    }
    const bool beams = options.combine && !scene.beams().empty();
    if (beams)
        recordBeamMaps(gpu, passes, scene);
    const ReceiverClusters receivers = receiverClusters(gpu, scene, options.pixels);
    recordEntitySort(gpu, passes, receivers);
    if (options.combine)
        recordCombine(gpu, passes, receivers, options.kernel, scene.mirrors());
    if (beams)
        recordBeams(gpu, passes, receivers);
    if (options.combine && options.pixels)
        recordPixelResolve(gpu, *options.pixels);
    computeToGraphics(gpu.cmd);

    recordRaster(gpu, passes, scene, targets, options.surfaces, options.pixels);
    recordPost(gpu, passes, targets, options.exposure);
}

ReceiverClusters receiverClusters(const GpuFrame& gpu, const GpuScene& scene,
                                  const PixelReceivers* pixels)
{
    if (pixels)
        return {pixels->targets.sceneSets[gpu.slot], pixels->targets.cull.handle};
    return {scene.slot(gpu.slot).set, scene.buffers().cull.handle};
}

void recordInstanceUpdate(const GpuFrame& gpu, const FramePasses& passes, const GpuScene& scene)
{
    const GpuZone zone(gpu.cmd, "instance_update");
    if (const std::uint32_t changed = scene.slot(gpu.slot).changedCount; changed > 0) {
        bindAndPush(gpu.cmd, passes.instanceUpdate, scene.slot(gpu.slot).set, changed);
        dispatchCovering(gpu.cmd, changed, 16);
    }
    computeToCompute(gpu.cmd);
}

void recordClusterCull(const GpuFrame& gpu, const FramePasses& passes, const GpuScene& scene)
{
    const GpuZone zone(gpu.cmd, "cluster_cull");
    const GpuSceneBuffers& b = scene.buffers();
    const CullResult nothing{{0, 1, 1}, {0, 1, 1}, 0, 0};
    const VkBufferCopy whole{.size = b.drawCommands.bytes};
    vkCmdUpdateBuffer(gpu.cmd, b.cull.handle, 0, sizeof(nothing), &nothing);
    vkCmdCopyBuffer(gpu.cmd, b.drawTemplate.handle, b.drawCommands.handle, 1, &whole);
    transferToCompute(gpu.cmd);
    bind(gpu.cmd, passes.clusterCull, scene.slot(gpu.slot).set, nullptr, 0);
    dispatchCovering(gpu.cmd, static_cast<std::uint32_t>(scene.data().clusters.size()), 64);
    computeToIndirect(gpu.cmd);
}

void recordEntitySort(const GpuFrame& gpu, const FramePasses& passes,
                      const ReceiverClusters& receivers)
{
    const GpuZone zone(gpu.cmd, "entity_sort");
    bind(gpu.cmd, passes.entitySort, receivers.set, nullptr, 0);
    vkCmdDispatchIndirect(gpu.cmd, receivers.cull, offsetof(CullResult, sortGroups));
    computeToIndirect(gpu.cmd);
}

void recordCombine(const GpuFrame& gpu, const FramePasses& passes,
                   const ReceiverClusters& receivers, Kernel kernel, bool mirrors)
{
    const GpuZone zone(gpu.cmd, "combine");
    bind(gpu.cmd, passes.combine(kernel, mirrors), receivers.set, nullptr, 0);
    vkCmdDispatchIndirect(gpu.cmd, receivers.cull, offsetof(CullResult, combineGroups));
}

void recordBeamMaps(const GpuFrame& gpu, const FramePasses& passes, const GpuScene& scene)
{
    PENUMBRA_ASSERT(!scene.beams().empty(), "no beams to draw maps of");
    const GpuZone zone(gpu.cmd, "beam_maps");
    const Image& maps = scene.beamMaps();
    computeToGraphics(gpu.cmd); // the instances
    transitionImage(gpu.cmd, maps.handle, maps.aspect, kUndefinedImage, kDepthTarget);
    const VkRenderingAttachmentInfo depth{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                          .imageView = maps.view,
                                          .imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                                          .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                          .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                          .clearValue = {.depthStencil = {.depth = 1}}};
    const VkRenderingInfo info{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                               .renderArea = {.extent = maps.extent},
                               .layerCount = 1,
                               .pDepthAttachment = &depth};
    vkCmdBeginRendering(gpu.cmd, &info);
    const std::vector<CasterRun> casters = casterRuns(scene.data());
    const GpuSceneBuffers& b = scene.buffers();
    const VkBuffer buffers[] = {b.casterPositions.handle, b.instances.handle};
    const VkDeviceSize offsets[] = {0, 0};
    vkCmdBindVertexBuffers(gpu.cmd, 0, 2, buffers, offsets);
    vkCmdBindIndexBuffer(gpu.cmd, b.casterIndices.handle, 0, VK_INDEX_TYPE_UINT32);
    for (std::uint32_t beam = 0; beam < scene.beams().size(); ++beam) {
        const VkRect2D area = beamMapArea(beam);
        const VkViewport viewport{static_cast<float>(area.offset.x),
                                  static_cast<float>(area.offset.y),
                                  static_cast<float>(area.extent.width),
                                  static_cast<float>(area.extent.height),
                                  0,
                                  1};
        vkCmdSetViewport(gpu.cmd, 0, 1, &viewport);
        vkCmdSetScissor(gpu.cmd, 0, 1, &area);
        bindAndPush(gpu.cmd, passes.beamMap, scene.slot(gpu.slot).set, beam);
        for (const CasterRun& run : casters) {
            const MeshRange& mesh = scene.data().meshes[run.mesh];
            vkCmdDrawIndexed(gpu.cmd, mesh.casterIndexCount, run.instanceCount,
                             mesh.firstCasterIndex,
                             static_cast<std::int32_t>(mesh.firstCasterVertex), run.firstInstance);
        }
    }
    vkCmdEndRendering(gpu.cmd);
    transitionImage(gpu.cmd, maps.handle, maps.aspect, kDepthTarget, kShaderRead);
}

void recordBeams(const GpuFrame& gpu, const FramePasses& passes, const ReceiverClusters& receivers)
{
    const GpuZone zone(gpu.cmd, "beams");
    computeToCompute(gpu.cmd); // the radiance of pass combine
    bind(gpu.cmd, passes.beams, receivers.set, nullptr, 0);
    vkCmdDispatchIndirect(gpu.cmd, receivers.cull, offsetof(CullResult, combineGroups));
}

void recordRaster(const GpuFrame& gpu, const FramePasses& passes, const GpuScene& scene,
                  const FrameTargets& targets, bool surfaces, const PixelReceivers* pixels)
{
    const GpuZone zone(gpu.cmd, "raster");
    transitionImage(gpu.cmd, targets.radiance.handle, targets.radiance.aspect, kUndefinedImage,
                    kColorTarget);
    transitionImage(gpu.cmd, targets.depth.handle, targets.depth.aspect, kUndefinedImage,
                    kDepthTarget);
    beginRendering(gpu.cmd, targets);
    vkCmdBindIndexBuffer(gpu.cmd, scene.buffers().indices.handle, 0, VK_INDEX_TYPE_UINT32);
    drawInstances(gpu, pixels ? passes.rasterPixels : passes.raster, scene,
                  receiverClusters(gpu, scene, pixels).set, surfaces);
    bind(gpu.cmd, passes.background, scene.slot(gpu.slot).set, nullptr, 0);
    vkCmdDraw(gpu.cmd, 3, 1, 0, 0);
    vkCmdEndRendering(gpu.cmd);
    transitionImage(gpu.cmd, targets.radiance.handle, targets.radiance.aspect, kColorTarget,
                    kShaderRead);
}

void recordPost(const GpuFrame& gpu, const FramePasses& passes, const FrameTargets& targets,
                float exposure)
{
    const GpuZone zone(gpu.cmd, "post");
    transitionImage(gpu.cmd, targets.display.handle, targets.display.aspect, kUndefinedImage,
                    kStorageImage);
    bindAndPush(gpu.cmd, passes.post, targets.postSet, exposure);
    const VkExtent2D extent = targets.display.extent;
    vkCmdDispatch(gpu.cmd, groupCount(extent.width, 8), groupCount(extent.height, 8), 1);
    transitionImage(gpu.cmd, targets.display.handle, targets.display.aspect, kStorageImage,
                    kCopySource);
}

SceneFeatures sceneFeatures(const SceneData& scene)
{
    return {!scene.lights.empty(), std::count(scene.hiders.begin(), scene.hiders.end(), true) > 0};
}

Result<FramePasses> createFramePasses(const Device& device, SceneFeatures features)
{
    const std::vector<Binding> scene(sceneBindings().begin(), sceneBindings().end());
    const std::uint32_t perInvocation = receiversPerInvocation(device);
    const auto selfScale = std::bit_cast<std::uint32_t>(kSelfVisibilityScale);
    const std::uint32_t lights = features.lights ? 1 : 0, hiders = features.hiders ? 1 : 0;

    FramePasses passes;
    Result<void> failed;
    const auto compute = [&](Pipeline& pipeline, const ComputeDesc& desc) {
        Result<Pipeline> made = createComputePipeline(device, desc);
        if (made)
            pipeline = std::move(*made);
        else
            failed = made.error();
    };
    const auto graphics = [&](Pipeline& pipeline, GraphicsDesc desc) {
        desc.bindings = scene;
        desc.colorFormats = {kRadianceFormat};
        desc.depthFormat = kDepthFormat;
        Result<Pipeline> made = createGraphicsPipeline(device, desc);
        if (made)
            pipeline = std::move(*made);
        else
            failed = made.error();
    };

    compute(passes.instanceUpdate,
            {.shader = "instance_update.comp", .bindings = scene, .pushBytes = 4});
    compute(passes.clusterCull, {.shader = "cluster_cull.comp", .bindings = scene});
    compute(
        passes.entitySort,
        {.shader = "entity_sort.comp", .bindings = scene, .constants = {0, 0, 0, lights, hiders}});
    compute(passes.combineLiteral, {.shader = "combine_literal.comp",
                                    .bindings = scene,
                                    .constants = {0, 0, selfScale, lights, hiders}});
    // On lavapipe a branch costs what is behind it, whether taken or not: 3 times the whole kernel.
    for (const std::uint32_t mirrors : {0u, 1u})
        compute(mirrors == 0 ? passes.combineExact : passes.combineMirrors,
                {.shader = "combine_exact.comp",
                 .bindings = scene,
                 .constants = {perInvocation, kClusterReceivers / perInvocation, selfScale, lights,
                               mirrors, hiders}});
    compute(passes.beams, {.shader = "beams.comp", .bindings = scene});
    compute(passes.post, {.shader = "post.comp",
                          .bindings = {{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
                                       {1, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}},
                          .pushBytes = 4});
    constexpr auto kPerInstance = VK_VERTEX_INPUT_RATE_INSTANCE;
    constexpr auto kVec4 = VK_FORMAT_R32G32B32A32_SFLOAT;
    constexpr auto kPerVertex = VK_VERTEX_INPUT_RATE_VERTEX;
    constexpr std::uint32_t kRow0 = offsetof(GpuInstance, worldFromObject0);
    GraphicsDesc raster{.name = "raster",
                        .vertexShader = "raster.vert",
                        .fragmentShader = "raster.frag",
                        .constants = {0},
                        .vertexBindings = {{0, sizeof(ReceiverTexels), kPerVertex},
                                           {1, sizeof(vec4), kPerVertex},
                                           {2, sizeof(GpuInstance), kPerInstance}},
                        .vertexAttributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0},
                                             {1, 1, kVec4, 0},
                                             {2, 2, kVec4, kRow0},
                                             {3, 2, kVec4, kRow0 + 16},
                                             {4, 2, kVec4, kRow0 + 32}}};
    graphics(passes.raster.plain, raster);
    graphics(passes.raster.surface, surfaceDesc(raster));
    raster.constants = {1}; // shaders/pixel_radiance.glsl
    graphics(passes.rasterPixels.plain, raster);
    graphics(passes.rasterPixels.surface, surfaceDesc(raster));
    Result<Pipeline> beamMap = createGraphicsPipeline(
        device,
        {.name = "beam_map",
         .vertexShader = "beam_map.vert",
         .bindings = scene,
         .pushBytes = sizeof(std::uint32_t),
         .vertexBindings = {{0, sizeof(vec3), kPerVertex}, {1, sizeof(GpuInstance), kPerInstance}},
         .vertexAttributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0},
                              {1, 1, kVec4, kRow0},
                              {2, 1, kVec4, kRow0 + 16},
                              {3, 1, kVec4, kRow0 + 32}},
         .depthFormat = kBeamMapFormat,
         .cull = VK_CULL_MODE_NONE});
    if (beamMap)
        passes.beamMap = std::move(*beamMap);
    else
        failed = beamMap.error();
    graphics(passes.background, {.name = "background",
                                 .vertexShader = "background.vert",
                                 .fragmentShader = "background.frag",
                                 .cull = VK_CULL_MODE_NONE,
                                 .depthWrite = false});
    if (!failed)
        return failed.error();
    return passes;
}

Result<FrameTargets> createFrameTargets(const Device& device, const FramePasses& passes,
                                        VkExtent2D extent)
{
    FrameTargets targets;
    const NamedImage images[] = {
        {targets.radiance, "radiance image", kRadianceFormat,
         VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT},
        {targets.depth, "depth image", kDepthFormat, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT},
        {targets.display, "display image", kDisplayFormat,
         VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT},
    };
    if (Result<void> made = createImages(device, extent, images); !made)
        return made.error();
    targets.sampler =
        createSampler(device, VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
    targets.sets = DescriptorSets(device);
    targets.postSet = targets.sets.allocate(passes.post.setLayout);
    DescriptorWriter(device, targets.postSet)
        .sampledImage(0, targets.radiance.view, targets.sampler)
        .storageImage(1, targets.display.view)
        .write();
    return targets;
}

} // namespace penumbra
