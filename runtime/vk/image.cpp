#include "runtime/vk/image.h"

#include <algorithm>

namespace penumbra {

VkImageAspectFlags aspectOf(VkFormat format)
{
    switch (format) {
    case VK_FORMAT_D16_UNORM:
    case VK_FORMAT_D32_SFLOAT:
    case VK_FORMAT_X8_D24_UNORM_PACK32:
        return VK_IMAGE_ASPECT_DEPTH_BIT;
    case VK_FORMAT_D24_UNORM_S8_UINT:
    case VK_FORMAT_D32_SFLOAT_S8_UINT:
        return VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
    default:
        return VK_IMAGE_ASPECT_COLOR_BIT;
    }
}

std::uint32_t bytesPerPixel(VkFormat format)
{
    switch (format) {
    case VK_FORMAT_R8_UNORM:
    case VK_FORMAT_R8_UINT:
        return 1;
    case VK_FORMAT_R16_SFLOAT:
    case VK_FORMAT_R16_UINT:
    case VK_FORMAT_D16_UNORM:
        return 2;
    case VK_FORMAT_R8G8B8A8_UNORM:
    case VK_FORMAT_R8G8B8A8_UINT:
    case VK_FORMAT_R8G8B8A8_SRGB:
    case VK_FORMAT_B8G8R8A8_UNORM:
    case VK_FORMAT_B8G8R8A8_SRGB:
    case VK_FORMAT_A2B10G10R10_UNORM_PACK32:
    case VK_FORMAT_B10G11R11_UFLOAT_PACK32:
    case VK_FORMAT_R16G16_SFLOAT:
    case VK_FORMAT_R32_UINT:
    case VK_FORMAT_R32_SINT:
    case VK_FORMAT_R32_SFLOAT:
    case VK_FORMAT_D32_SFLOAT:
        return 4;
    case VK_FORMAT_R16G16B16A16_UNORM:
    case VK_FORMAT_R16G16B16A16_SFLOAT:
    case VK_FORMAT_R32G32_UINT:
    case VK_FORMAT_R32G32_SFLOAT:
        return 8;
    case VK_FORMAT_R32G32B32A32_UINT:
    case VK_FORMAT_R32G32B32A32_SINT:
    case VK_FORMAT_R32G32B32A32_SFLOAT:
        return 16;
    default:
        break;
    }
    PENUMBRA_ASSERT(false, "size of a pixel of VkFormat {}", static_cast<int>(format));
    return 0;
}

Result<Image> createImage(const Device& device, const ImageDesc& desc)
{
    PENUMBRA_ASSERT(desc.extent.width > 0 && desc.extent.height > 0, "image '{}' is empty",
                    desc.name);
    VkImageCreateInfo info = {VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = desc.format;
    info.extent = {desc.extent.width, desc.extent.height, 1};
    info.mipLevels = desc.mipLevels;
    info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = desc.usage | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    info.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;

    VkImageFormatProperties limits;
    const VkResult usable = vkGetPhysicalDeviceImageFormatProperties(
        device.physical, info.format, info.imageType, info.tiling, info.usage, 0, &limits);
    if (usable == VK_ERROR_FORMAT_NOT_SUPPORTED)
        return Error{
            fmt::format("image '{}': the device has no VkFormat {} for usage {:#x}; choose "
                        "another format",
                        desc.name, static_cast<int>(desc.format), info.usage)};
    if (Result<void> ok = vkTry(usable, fmt::format("describe image '{}'", desc.name)); !ok)
        return ok.error();
    if (desc.extent.width > limits.maxExtent.width || desc.extent.height > limits.maxExtent.height)
        return Error{
            fmt::format("image '{}' is {}x{}, the device allows {}x{}; choose a smaller size",
                        desc.name, desc.extent.width, desc.extent.height, limits.maxExtent.width,
                        limits.maxExtent.height)};

    Image image;
    image.extent = desc.extent;
    image.format = desc.format;
    image.aspect = aspectOf(desc.format);
    image.mipLevels = desc.mipLevels;
    VkImage handle = VK_NULL_HANDLE;
    if (Result<void> ok = vkTry(vkCreateImage(device.handle, &info, nullptr, &handle),
                                fmt::format("create image '{}'", desc.name));
        !ok)
        return ok.error();
    image.handle = UniqueImage(device.handle, handle);
    setName(device, VK_OBJECT_TYPE_IMAGE, handle, desc.name);

    VkMemoryRequirements requirements;
    vkGetImageMemoryRequirements(device.handle, handle, &requirements);
    VkMemoryDedicatedAllocateInfo dedicated = {VK_STRUCTURE_TYPE_MEMORY_DEDICATED_ALLOCATE_INFO};
    dedicated.image = handle;
    Result<Memory> memory =
        allocateMemory(device, requirements, MemoryKind::DeviceLocal, dedicated, desc.name);
    if (!memory)
        return memory.error();
    image.memory = *std::move(memory);
    if (Result<void> ok = vkTry(vkBindImageMemory(device.handle, handle, image.memory.handle, 0),
                                fmt::format("bind memory to '{}'", desc.name));
        !ok)
        return ok.error();

    constexpr VkImageUsageFlags kViewed = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT |
                                          VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                          VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    if ((desc.usage & kViewed) == 0) // only copied: Vulkan allows no view
        return image;
    VkImageViewCreateInfo viewInfo = {VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    viewInfo.image = handle;
    viewInfo.viewType = VK_IMAGE_VIEW_TYPE_2D;
    viewInfo.format = desc.format;
    viewInfo.subresourceRange = {image.aspect, 0, desc.mipLevels, 0, 1};
    VkImageView view = VK_NULL_HANDLE;
    if (Result<void> ok = vkTry(vkCreateImageView(device.handle, &viewInfo, nullptr, &view),
                                fmt::format("create a view of '{}'", desc.name));
        !ok)
        return ok.error();
    image.view = UniqueImageView(device.handle, view);
    setName(device, VK_OBJECT_TYPE_IMAGE_VIEW, view, desc.name);
    return image;
}

Result<void> createImages(const Device& device, VkExtent2D extent,
                          std::span<const NamedImage> images)
{
    for (const auto& [image, name, format, usage] : images) {
        Result<Image> made =
            createImage(device, {.name = name, .extent = extent, .format = format, .usage = usage});
        if (!made)
            return made.error();
        image = std::move(*made);
    }
    return {};
}

UniqueSampler createSampler(const Device& device, VkFilter filter, VkSamplerAddressMode addressMode)
{
    return createSampler(device, {.mag = filter,
                                  .min = filter,
                                  .mipmaps = VK_SAMPLER_MIPMAP_MODE_NEAREST,
                                  .maxLod = 0,
                                  .u = addressMode,
                                  .v = addressMode});
}

UniqueSampler createSampler(const Device& device, const SamplerDesc& desc)
{
    VkSamplerCreateInfo info = {VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    info.magFilter = desc.mag;
    info.minFilter = desc.min;
    info.mipmapMode = desc.mipmaps;
    info.maxLod = desc.maxLod;
    info.addressModeU = desc.u;
    info.addressModeV = desc.v;
    info.addressModeW = desc.u;
    VkSampler sampler = VK_NULL_HANDLE;
    vkCheck(vkCreateSampler(device.handle, &info, nullptr, &sampler), "create a sampler");
    return {device.handle, sampler};
}

VkExtent2D mipExtent(VkExtent2D extent, std::uint32_t level)
{
    return {std::max(extent.width >> level, 1u), std::max(extent.height >> level, 1u)};
}

} // namespace penumbra
