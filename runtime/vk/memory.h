// Device memory, one allocation per object: simple, and far below the limit for a scene of ours.
#pragma once

#include "runtime/vk/device.h"

#include <cstddef>

namespace penumbra {

enum class MemoryKind {
    DeviceLocal, // never mapped, also where the driver would allow it: one path everywhere
    Upload,      // mapped, coherent: the CPU writes, the GPU reads
    Readback,    // mapped, coherent, cached where there is such: the GPU writes, the CPU reads
};

// Move-only.
struct Memory {
    UniqueMemory handle;
    std::byte* mapped = nullptr;      // null for DeviceLocal
    std::shared_ptr<void> allocation; // lowers Device::allocations at its end
};

// `dedicated` names the buffer or image that the memory is for. Error: out of memory, or
// maxMemoryAllocationCount reached.
Result<Memory> allocateMemory(const Device& device, const VkMemoryRequirements& requirements,
                              MemoryKind kind, const VkMemoryDedicatedAllocateInfo& dedicated,
                              const std::string& name);

} // namespace penumbra
