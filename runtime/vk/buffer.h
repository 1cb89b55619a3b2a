// A buffer with its own memory, device address and, on demand, a texel view.
#pragma once

#include "runtime/vk/memory.h"

namespace penumbra {

struct BufferDesc {
    std::string name;       // shown by validation and captures
    VkDeviceSize bytes = 0; // > 0
    VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT; // copies and address: always on
    MemoryKind memory = MemoryKind::DeviceLocal;
    VkFormat texelFormat = VK_FORMAT_UNDEFINED; // set: makes `texels`, for [u]samplerBuffer
};

// Move-only. Destroying it while the GPU uses it is a bug: see FrameRing::retire.
struct Buffer {
    Memory memory;
    UniqueBuffer handle;
    UniqueBufferView texels;     // whole buffer in BufferDesc::texelFormat
    VkDeviceSize bytes = 0;      // as asked for
    VkDeviceAddress address = 0; // for buffer references in shaders
    std::byte* mapped = nullptr; // [bytes], null for DeviceLocal
};

// Error: out of memory, larger than the device's buffers, or more texels than its texel buffers
// hold (128 M on lavapipe).
Result<Buffer> createBuffer(const Device& device, const BufferDesc& desc);

} // namespace penumbra
