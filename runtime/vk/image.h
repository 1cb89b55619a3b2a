// A 2D image of one layer, with its own memory and a view of all its mip levels, and samplers.
#pragma once

#include "runtime/vk/memory.h"

namespace penumbra {

struct ImageDesc {
    std::string name;
    VkExtent2D extent = {};                // pixels, > 0
    VkFormat format = VK_FORMAT_UNDEFINED; // its aspect follows from it: colour or depth
    VkImageUsageFlags usage = 0;           // copies in both directions: always on
    std::uint32_t mipLevels = 1;           // each half the one before, rounded down, at least 1
};

// Move-only. Starts in VK_IMAGE_LAYOUT_UNDEFINED; the user of the image keeps track of the layout.
struct Image {
    Memory memory;
    UniqueImage handle;
    UniqueImageView view;
    VkExtent2D extent = {};
    VkFormat format = VK_FORMAT_UNDEFINED;
    VkImageAspectFlags aspect = 0;
    std::uint32_t mipLevels = 1;
};

// Error: out of memory, larger than the device's images, or a format without that usage.
Result<Image> createImage(const Device& device, const ImageDesc& desc);

// Several of one size. Error: as of createImage; those before it are made.
struct NamedImage {
    Image& image;
    const char* name;
    VkFormat format;
    VkImageUsageFlags usage;
};
Result<void> createImages(const Device& device, VkExtent2D extent,
                          std::span<const NamedImage> images);

[[nodiscard]] UniqueSampler createSampler(const Device& device, VkFilter filter,
                                          VkSamplerAddressMode addressMode);

// For images with mip levels.
struct SamplerDesc {
    VkFilter mag = VK_FILTER_LINEAR, min = VK_FILTER_LINEAR;
    VkSamplerMipmapMode mipmaps = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    float maxLod = VK_LOD_CLAMP_NONE; // 0.25 with nearest mipmaps: the first level alone
    VkSamplerAddressMode u = VK_SAMPLER_ADDRESS_MODE_REPEAT, v = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    friend bool operator==(const SamplerDesc&, const SamplerDesc&) = default;
};
[[nodiscard]] UniqueSampler createSampler(const Device& device, const SamplerDesc& desc);

[[nodiscard]] VkExtent2D mipExtent(VkExtent2D extent, std::uint32_t level);

[[nodiscard]] VkImageAspectFlags aspectOf(VkFormat format);
// Bytes per pixel of the formats that the project uploads or reads back; asserts for others.
[[nodiscard]] std::uint32_t bytesPerPixel(VkFormat format);

} // namespace penumbra
