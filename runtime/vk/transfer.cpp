#include "runtime/vk/transfer.h"

#include "runtime/vk/barriers.h"

namespace penumbra {
namespace {

// The staging buffer of one copy.
Result<Buffer> createStaging(const Device& device, VkDeviceSize bytes, MemoryKind kind)
{
    return createBuffer(device, {.name = "staging", .bytes = bytes, .usage = 0, .memory = kind});
}

VkDeviceSize levelBytes(const Image& image, std::uint32_t level)
{
    const VkExtent2D extent = mipExtent(image.extent, level);
    return VkDeviceSize{extent.width} * extent.height * bytesPerPixel(image.format);
}

VkBufferImageCopy wholeLevel(const Image& image, std::uint32_t level, VkDeviceSize offset)
{
    PENUMBRA_ASSERT((image.aspect & (image.aspect - 1)) == 0, "copies of one aspect only");
    const VkExtent2D extent = mipExtent(image.extent, level);
    VkBufferImageCopy region = {};
    region.bufferOffset = offset;
    region.imageSubresource = {image.aspect, level, 0, 1};
    region.imageExtent = {extent.width, extent.height, 1};
    return region;
}

// Whoever used the image before, or will: submitAndWait's barriers cover the accesses.
ImageUse anyUse(VkImageLayout layout)
{
    return {layout, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
            VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT};
}

} // namespace

Result<void> submitAndWait(const Device& device, const std::function<void(VkCommandBuffer)>& record)
{
    VkCommandPoolCreateInfo poolInfo = {VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    poolInfo.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    poolInfo.queueFamilyIndex = device.queueFamily;
    VkCommandPool poolHandle = VK_NULL_HANDLE;
    if (Result<void> ok = vkTry(vkCreateCommandPool(device.handle, &poolInfo, nullptr, &poolHandle),
                                "create a command pool");
        !ok)
        return ok;
    const UniqueCommandPool pool(device.handle, poolHandle);

    VkCommandBufferAllocateInfo cmdInfo = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    cmdInfo.commandPool = pool;
    cmdInfo.commandBufferCount = 1;
    VkCommandBuffer cmd = VK_NULL_HANDLE;
    if (Result<void> ok = vkTry(vkAllocateCommandBuffers(device.handle, &cmdInfo, &cmd),
                                "allocate a command buffer");
        !ok)
        return ok;

    const VkFenceCreateInfo fenceInfo = {VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    VkFence fenceHandle = VK_NULL_HANDLE;
    if (Result<void> ok = vkTry(vkCreateFence(device.handle, &fenceInfo, nullptr, &fenceHandle),
                                "create a fence");
        !ok)
        return ok;
    const UniqueFence fence(device.handle, fenceHandle);

    VkCommandBufferBeginInfo begin = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    vkCheck(vkBeginCommandBuffer(cmd, &begin), "begin one-shot commands");
    fullBarrier(cmd); // after everything submitted before …
    record(cmd);
    fullBarrier(cmd); // … before everything submitted later, and the CPU
    if (Result<void> ok = vkTry(vkEndCommandBuffer(cmd), "record one-shot commands"); !ok)
        return ok;

    VkCommandBufferSubmitInfo cmdSubmit = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
    cmdSubmit.commandBuffer = cmd;
    VkSubmitInfo2 submitInfo = {VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    submitInfo.commandBufferInfoCount = 1;
    submitInfo.pCommandBufferInfos = &cmdSubmit;
    if (Result<void> ok = submit(device, submitInfo, fence); !ok)
        return ok;
    return vkTry(vkWaitForFences(device.handle, 1, &fenceHandle, VK_TRUE, UINT64_MAX),
                 "wait for one-shot commands");
}

Result<void> upload(const Device& device, const Buffer& target, std::span<const std::byte> bytes,
                    VkDeviceSize offset)
{
    PENUMBRA_ASSERT(offset <= target.bytes && bytes.size() <= target.bytes - offset,
                    "{} bytes at {} into a buffer of {}", bytes.size(), offset, target.bytes);
    if (bytes.empty())
        return {};
    const Result<Buffer> staging = createStaging(device, bytes.size(), MemoryKind::Upload);
    if (!staging)
        return staging.error();
    std::memcpy(staging->mapped, bytes.data(), bytes.size());
    return submitAndWait(device, [&](VkCommandBuffer cmd) {
        const VkBufferCopy region = {0, offset, bytes.size()};
        vkCmdCopyBuffer(cmd, staging->handle, target.handle, 1, &region);
    });
}

Result<void> upload(const Device& device, const Image& target, std::span<const std::byte> pixels,
                    VkImageLayout finalLayout)
{
    std::vector<VkBufferImageCopy> regions;
    VkDeviceSize bytes = 0;
    for (std::uint32_t level = 0; level < target.mipLevels; ++level) {
        regions.push_back(wholeLevel(target, level, bytes));
        bytes += levelBytes(target, level);
    }
    PENUMBRA_ASSERT(pixels.size() == bytes, "{} bytes for an image of {}", pixels.size(), bytes);
    const Result<Buffer> staging = createStaging(device, pixels.size(), MemoryKind::Upload);
    if (!staging)
        return staging.error();
    std::memcpy(staging->mapped, pixels.data(), pixels.size());
    return submitAndWait(device, [&](VkCommandBuffer cmd) {
        transitionImage(cmd, target.handle, target.aspect, kUndefinedImage, kCopyTarget);
        vkCmdCopyBufferToImage(cmd, staging->handle, target.handle, kCopyTarget.layout,
                               static_cast<std::uint32_t>(regions.size()), regions.data());
        transitionImage(cmd, target.handle, target.aspect, kCopyTarget, anyUse(finalLayout));
    });
}

Result<std::vector<std::byte>> readBack(const Device& device, const Buffer& source,
                                        VkDeviceSize offset, VkDeviceSize bytes)
{
    if (bytes == VK_WHOLE_SIZE && offset <= source.bytes)
        bytes = source.bytes - offset;
    PENUMBRA_ASSERT(offset <= source.bytes && bytes <= source.bytes - offset,
                    "{} bytes at {} of a buffer of {}", bytes, offset, source.bytes);
    if (bytes == 0)
        return std::vector<std::byte>();
    const Result<Buffer> staging = createStaging(device, bytes, MemoryKind::Readback);
    if (!staging)
        return staging.error();
    Result<void> copied = submitAndWait(device, [&](VkCommandBuffer cmd) {
        const VkBufferCopy region = {offset, 0, bytes};
        vkCmdCopyBuffer(cmd, source.handle, staging->handle, 1, &region);
    });
    if (!copied)
        return copied.error();
    return std::vector<std::byte>(staging->mapped, staging->mapped + bytes);
}

Result<std::vector<std::byte>> readBack(const Device& device, const Image& source,
                                        VkImageLayout layout)
{
    const VkDeviceSize bytes = levelBytes(source, 0);
    const Result<Buffer> staging = createStaging(device, bytes, MemoryKind::Readback);
    if (!staging)
        return staging.error();
    Result<void> copied = submitAndWait(device, [&](VkCommandBuffer cmd) {
        const VkBufferImageCopy region = wholeLevel(source, 0, 0);
        transitionImage(cmd, source.handle, source.aspect, anyUse(layout), kCopySource);
        vkCmdCopyImageToBuffer(cmd, source.handle, kCopySource.layout, staging->handle, 1, &region);
        transitionImage(cmd, source.handle, source.aspect, kCopySource, anyUse(layout));
    });
    if (!copied)
        return copied.error();
    return std::vector<std::byte>(staging->mapped, staging->mapped + bytes);
}

Result<Buffer> createBufferWith(const Device& device, BufferDesc desc,
                                std::span<const std::byte> bytes)
{
    if (desc.bytes == 0)
        desc.bytes = bytes.size();
    Result<Buffer> buffer = createBuffer(device, desc);
    if (!buffer)
        return buffer;
    if (Result<void> ok = upload(device, *buffer, bytes); !ok)
        return ok.error();
    return buffer;
}

} // namespace penumbra
