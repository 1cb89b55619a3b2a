// A 2D image of one mip level and one layer, with its own memory and a view, and samplers.
#pragma once

#include "runtime/vk/memory.h"

namespace penumbra {

struct ImageDesc {
    std::string name;
    VkExtent2D extent = {};                // pixels, > 0
    VkFormat format = VK_FORMAT_UNDEFINED; // its aspect follows from it: colour or depth
    VkImageUsageFlags usage = 0;           // copies in both directions: always on
};

// Move-only. Starts in VK_IMAGE_LAYOUT_UNDEFINED; the user of the image keeps track of the layout.
struct Image {
    Memory memory;
    UniqueImage handle;
    UniqueImageView view;
    VkExtent2D extent = {};
    VkFormat format = VK_FORMAT_UNDEFINED;
    VkImageAspectFlags aspect = 0;
};

// Error: out of memory, larger than the device's images, or a format without that usage.
Result<Image> createImage(const Device& device, const ImageDesc& desc);

[[nodiscard]] UniqueSampler createSampler(const Device& device, VkFilter filter,
                                          VkSamplerAddressMode addressMode);

[[nodiscard]] VkImageAspectFlags aspectOf(VkFormat format);
// Bytes per pixel of the formats that the project uploads or reads back; asserts for others.
[[nodiscard]] std::uint32_t bytesPerPixel(VkFormat format);

} // namespace penumbra
