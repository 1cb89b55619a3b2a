#include "runtime/vk/memory.h"

#include <array>
#include <optional>

namespace penumbra {
namespace {

constexpr VkMemoryPropertyFlags kMapped =
    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;

// In order of preference. Vulkan promises that the second of each exists for every buffer.
std::array<VkMemoryPropertyFlags, 2> wishes(MemoryKind kind)
{
    switch (kind) {
    case MemoryKind::Upload:
        return {kMapped, kMapped};
    case MemoryKind::Readback:
        return {kMapped | VK_MEMORY_PROPERTY_HOST_CACHED_BIT, kMapped};
    case MemoryKind::DeviceLocal:
        break;
    }
    return {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0};
}

std::optional<std::uint32_t> findType(const VkPhysicalDeviceMemoryProperties& memory,
                                      std::uint32_t allowed, MemoryKind kind)
{
    for (const VkMemoryPropertyFlags wish : wishes(kind))
        for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i)
            if ((allowed >> i & 1) != 0 && (memory.memoryTypes[i].propertyFlags & wish) == wish)
                return i;
    return std::nullopt;
}

} // namespace

Result<Memory> allocateMemory(const Device& device, const VkMemoryRequirements& requirements,
                              MemoryKind kind, const VkMemoryDedicatedAllocateInfo& dedicated,
                              const std::string& name)
{
    const std::shared_ptr<AllocationCount> count = device.allocations;
    const std::uint32_t live = count->live.fetch_add(1) + 1;
    Memory memory;
    memory.allocation =
        std::shared_ptr<void>(count.get(), [count](void*) { count->live.fetch_sub(1); });
    if (live > count->limit)
        return Error{
            fmt::format("cannot allocate '{}': the device allows {} allocations; use fewer, "
                        "larger buffers",
                        name, count->limit)};
    const std::optional<std::uint32_t> type =
        findType(device.memory, requirements.memoryTypeBits, kind);
    if (!type)
        return Error{
            fmt::format("cannot allocate '{}': the device has no memory that the CPU may map "
                        "for it",
                        name)};

    VkMemoryAllocateFlagsInfo flags = {VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO};
    flags.pNext = &dedicated;
    flags.flags = dedicated.buffer ? VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT : 0;
    VkMemoryAllocateInfo info = {VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    info.pNext = &flags;
    info.allocationSize = requirements.size;
    info.memoryTypeIndex = *type;
    VkDeviceMemory handle = VK_NULL_HANDLE;
    if (Result<void> ok = vkTry(vkAllocateMemory(device.handle, &info, nullptr, &handle),
                                fmt::format("allocate {} bytes for '{}'", requirements.size, name));
        !ok)
        return ok.error();
    memory.handle = UniqueMemory(device.handle, handle);
    setName(device, VK_OBJECT_TYPE_DEVICE_MEMORY, handle, name);

    if (kind != MemoryKind::DeviceLocal) {
        void* mapped = nullptr;
        if (Result<void> ok =
                vkTry(vkMapMemory(device.handle, handle, 0, VK_WHOLE_SIZE, 0, &mapped),
                      fmt::format("map '{}'", name));
            !ok)
            return ok.error();
        memory.mapped = static_cast<std::byte*>(mapped);
    }
    return memory;
}

} // namespace penumbra
