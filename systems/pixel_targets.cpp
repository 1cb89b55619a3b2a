#include "systems/pixel_targets.h"

#include "runtime/vk/transfer.h"
#include "shaders/shared/pixel.h"
#include "systems/pixel_receivers.h"

#include <algorithm>
#include <numeric>

namespace penumbra {

namespace {

constexpr VkFormat kWords = VK_FORMAT_R32G32B32A32_UINT;
constexpr VkFormat kWord = VK_FORMAT_R32_UINT;
constexpr VkFormat kRadiance = VK_FORMAT_R16G16B16A16_SFLOAT;

// Per block of pixels: clusters that its receivers fill, and some for instances whose receivers do
// not fill their last one, and for the edges of objects at rate 2, on average over the picture.
std::uint32_t fullClusters(std::uint32_t rate)
{
    return kPixelBlock * kPixelBlock / (rate * rate) / kClusterReceivers;
}
constexpr std::uint32_t kMoreClusters = 8;

constexpr const char* kRemedy =
    "a smaller picture, pixel receivers of half resolution, or vertices as receivers";

Result<void> createImages(const Device& device, PixelTargets& targets)
{
    constexpr VkImageUsageFlags kDrawn =
        VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    const NamedImage images[] = {
        {targets.geometry, "pixel geometry", kWords, kDrawn},
        {targets.selfVisibility, "pixel self-visibility", kWords, kDrawn},
        {targets.instance, "pixel instances", kWord, kDrawn},
        {targets.radiance, "pixel radiance", kRadiance,
         VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT},
    };
    return createImages(device, targets.extent, images);
}

Result<void> createBuffers(const Device& device, PixelTargets& targets)
{
    constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    constexpr VkBufferUsageFlags kTexels = kStorage | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;
    const VkDeviceSize clusters = targets.capacity, receivers = clusters * kClusterReceivers;
    const VkDeviceSize pixels = VkDeviceSize{targets.extent.width} * targets.extent.height;
    const struct {
        Buffer& buffer;
        const char* name;
        VkDeviceSize bytes;
        VkBufferUsageFlags usage;
        VkFormat texels;
    } buffers[] = {
        {targets.receivers, "pixel receivers", receivers * sizeof(ReceiverTexels), kTexels, kWords},
        {targets.bounds, "pixel bounds", clusters * sizeof(ClusterBounds), kStorage, {}},
        {targets.clusters, "pixel clusters", clusters * sizeof(SceneCluster), kStorage, {}},
        {targets.cull,
         "pixel cull result",
         sizeof(CullResult),
         kStorage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT,
         {}},
        {targets.visible, "visible pixel clusters", clusters * 4, kTexels, kWord},
        {targets.lists, "pixel lists", clusters * kListStride * 4, kTexels, kWord},
        {targets.receiverRadiance, "radiance of pixel receivers", receivers * sizeof(vec4), kTexels,
         VK_FORMAT_R32G32B32A32_SFLOAT},
        {targets.counts, "pixel counts", clusters * 4, kStorage, {}},
        {targets.slots, "pixel slots", pixels * 4, kTexels, kWord},
    };
    for (const auto& [buffer, name, bytes, usage, texels] : buffers) {
        if (bytes > device.properties.limits.maxStorageBufferRange)
            return Error{fmt::format("{} of a picture of {}x{} take {} bytes, the device binds {}; "
                                     "use {}",
                                     name, targets.extent.width, targets.extent.height, bytes,
                                     device.properties.limits.maxStorageBufferRange, kRemedy)};
        Result<Buffer> made = createBuffer(
            device, {.name = name, .bytes = bytes, .usage = usage, .texelFormat = texels});
        if (!made)
            return made.error();
        buffer = std::move(*made);
    }
    // Every cluster is visible. Lanes that no pixel has filled yet must hold numbers.
    std::vector<std::uint32_t> visible(targets.capacity);
    std::iota(visible.begin(), visible.end(), 0u);
    if (Result<void> done = upload(device, targets.visible, std::as_bytes(std::span(visible)));
        !done)
        return done;
    return submitAndWait(device, [&](VkCommandBuffer cmd) {
        vkCmdFillBuffer(cmd, targets.receivers.handle, 0, VK_WHOLE_SIZE, 0);
    });
}

} // namespace

Result<PixelTargets> createPixelTargets(const Device& device, const PixelPasses& passes,
                                        const GpuScene& scene, VkExtent2D extent)
{
    PixelTargets targets;
    targets.extent = extent;
    const std::uint32_t blocks =
        groupCount(extent.width, kPixelBlock) * groupCount(extent.height, kPixelBlock);
    const std::uint32_t groups = device.properties.limits.maxComputeWorkGroupCount[0];
    if (blocks * (fullClusters(passes.rate) + 1) > groups)
        return Error{fmt::format("a picture of {}x{} has {} clusters of pixels, the device "
                                 "dispatches {}; use {}",
                                 extent.width, extent.height, blocks * fullClusters(passes.rate),
                                 groups, kRemedy)};
    targets.capacity = std::min(blocks * (fullClusters(passes.rate) + kMoreClusters), groups);
    if (Result<void> done = createImages(device, targets); !done)
        return done.error();
    if (Result<void> done = createBuffers(device, targets); !done)
        return done.error();

    targets.sampler =
        createSampler(device, VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
    targets.sets = DescriptorSets(device);
    targets.set = targets.sets.allocate(passes.clusters.setLayout);
    DescriptorWriter(device, targets.set)
        .sampledImage(0, targets.geometry.view, targets.sampler)
        .sampledImage(1, targets.selfVisibility.view, targets.sampler)
        .sampledImage(2, targets.instance.view, targets.sampler)
        .storageBuffer(3, targets.receivers.handle)
        .storageBuffer(4, targets.bounds.handle)
        .storageBuffer(5, targets.clusters.handle)
        .storageBuffer(6, targets.cull.handle)
        .storageBuffer(7, targets.counts.handle)
        .storageBuffer(8, targets.slots.handle)
        .texels(9, targets.receivers.texels)
        .texels(10, targets.slots.texels)
        .texels(11, targets.receiverRadiance.texels)
        .storageImage(12, targets.radiance.view)
        .write();
    for (std::uint32_t slot = 0; slot < scene.slotCount(); ++slot) {
        targets.sceneSets.push_back(targets.sets.allocate(passes.gbuffer.setLayout));
        scene.writeSet(device, targets.sceneSets.back(), slot,
                       {targets.receivers, targets.bounds, targets.clusters, targets.cull,
                        targets.visible, targets.lists, targets.receiverRadiance,
                        &targets.radiance});
    }
    return targets;
}

std::uint64_t gpuBytes(const PixelTargets& t)
{
    const std::uint64_t pixels = std::uint64_t{t.extent.width} * t.extent.height;
    std::uint64_t sum = 0;
    for (const Image* image : {&t.geometry, &t.selfVisibility, &t.instance, &t.radiance})
        sum += pixels * bytesPerPixel(image->format);
    for (const Buffer* buffer : {&t.receivers, &t.bounds, &t.clusters, &t.cull, &t.visible,
                                 &t.lists, &t.receiverRadiance, &t.counts, &t.slots})
        sum += buffer->bytes;
    return sum;
}

Result<GbufferPixels> readGbuffer(const Device& device, const PixelTargets& targets)
{
    constexpr auto kLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    const Result<std::vector<std::byte>> geometry = readBack(device, targets.geometry, kLayout);
    const Result<std::vector<std::byte>> self = readBack(device, targets.selfVisibility, kLayout);
    const Result<std::vector<std::byte>> instance = readBack(device, targets.instance, kLayout);
    for (const auto* part : {&geometry, &self, &instance})
        if (!*part)
            return part->error();
    GbufferPixels pixels;
    pixels.instances.resize(instance->size() / 4);
    pixels.receivers.resize(pixels.instances.size());
    std::memcpy(pixels.instances.data(), instance->data(), instance->size());
    for (std::size_t i = 0; i < pixels.receivers.size(); ++i) {
        std::memcpy(&pixels.receivers[i].geometry, geometry->data() + 16 * i, 16);
        std::memcpy(&pixels.receivers[i].selfVisibility, self->data() + 16 * i, 16);
    }
    return pixels;
}

} // namespace penumbra
