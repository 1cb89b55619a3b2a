// One-shot work and copies between CPU and GPU. Each call submits and waits, and is ordered after
// everything submitted before it and before everything submitted later: for loading and tests, not
// for a frame. Thread-safe on a device of our own.
#pragma once

#include "runtime/vk/buffer.h"
#include "runtime/vk/image.h"

#include <cstring>
#include <functional>
#include <type_traits>

namespace penumbra {

// Errors of all functions here: out of memory, device lost.
Result<void> submitAndWait(const Device& device,
                           const std::function<void(VkCommandBuffer)>& record);

// Fills [offset, offset + bytes.size()) of `target`.
Result<void> upload(const Device& device, const Buffer& target, std::span<const std::byte> bytes,
                    VkDeviceSize offset = 0);

// Fills the image and leaves it in `finalLayout`. `pixels`: rows without padding, one mip level
// after the other.
Result<void> upload(const Device& device, const Image& target, std::span<const std::byte> pixels,
                    VkImageLayout finalLayout);

Result<std::vector<std::byte>> readBack(const Device& device, const Buffer& source,
                                        VkDeviceSize offset = 0,
                                        VkDeviceSize bytes = VK_WHOLE_SIZE);

// The first mip level, rows without padding. The image is in `layout` before and after.
Result<std::vector<std::byte>> readBack(const Device& device, const Image& source,
                                        VkImageLayout layout);

// A device-local buffer of `desc` with contents; desc.bytes may be 0 and then follows from them.
Result<Buffer> createBufferWith(const Device& device, BufferDesc desc,
                                std::span<const std::byte> bytes);

// The whole buffer as elements; its size is a multiple of sizeof(T).
template <class T>
Result<std::vector<T>> readBackAs(const Device& device, const Buffer& source)
{
    static_assert(std::is_trivially_copyable_v<T>);
    Result<std::vector<std::byte>> bytes = readBack(device, source);
    if (!bytes)
        return bytes.error();
    PENUMBRA_ASSERT(bytes->size() % sizeof(T) == 0, "{} bytes, elements of {}", bytes->size(),
                    sizeof(T));
    std::vector<T> elements(bytes->size() / sizeof(T));
    std::memcpy(elements.data(), bytes->data(), bytes->size());
    return elements;
}

} // namespace penumbra
