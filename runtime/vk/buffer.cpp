#include "runtime/vk/buffer.h"

#include "runtime/vk/image.h"

namespace penumbra {
namespace {

Result<void> checkSize(const Device& device, const BufferDesc& desc)
{
    VkPhysicalDeviceMaintenance4Properties limits = {
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_PROPERTIES};
    VkPhysicalDeviceProperties2 properties = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    properties.pNext = &limits;
    vkGetPhysicalDeviceProperties2(device.physical, &properties);
    if (desc.bytes > limits.maxBufferSize)
        return Error{fmt::format("buffer '{}' has {} bytes, the device allows {}; split the data",
                                 desc.name, desc.bytes, limits.maxBufferSize)};
    if (desc.texelFormat == VK_FORMAT_UNDEFINED)
        return {};
    const VkDeviceSize texels = desc.bytes / bytesPerPixel(desc.texelFormat);
    if (texels > device.properties.limits.maxTexelBufferElements)
        return Error{fmt::format("texel buffer '{}' has {} texels, the device allows {}; use fewer "
                                 "or smaller fields",
                                 desc.name, texels,
                                 device.properties.limits.maxTexelBufferElements)};
    return {};
}

} // namespace

Result<Buffer> createBuffer(const Device& device, const BufferDesc& desc)
{
    PENUMBRA_ASSERT(desc.bytes > 0, "buffer '{}' is empty", desc.name);
    if (Result<void> ok = checkSize(device, desc); !ok)
        return ok.error();

    const bool hasTexels = desc.texelFormat != VK_FORMAT_UNDEFINED;
    VkBufferCreateInfo info = {VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = desc.bytes;
    info.usage = desc.usage | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT |
                 VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    if (hasTexels)
        info.usage |= VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;

    Buffer buffer;
    buffer.bytes = desc.bytes;
    VkBuffer handle = VK_NULL_HANDLE;
    if (Result<void> ok = vkTry(vkCreateBuffer(device.handle, &info, nullptr, &handle),
                                fmt::format("create buffer '{}'", desc.name));
        !ok)
        return ok.error();
    buffer.handle = UniqueBuffer(device.handle, handle);
    setName(device, VK_OBJECT_TYPE_BUFFER, handle, desc.name);

    VkMemoryRequirements requirements;
    vkGetBufferMemoryRequirements(device.handle, handle, &requirements);
    VkMemoryDedicatedAllocateInfo dedicated = {VK_STRUCTURE_TYPE_MEMORY_DEDICATED_ALLOCATE_INFO};
    dedicated.buffer = handle;
    Result<Memory> memory = allocateMemory(device, requirements, desc.memory, dedicated, desc.name);
    if (!memory)
        return memory.error();
    buffer.memory = *std::move(memory);
    buffer.mapped = buffer.memory.mapped;
    if (Result<void> ok = vkTry(vkBindBufferMemory(device.handle, handle, buffer.memory.handle, 0),
                                fmt::format("bind memory to '{}'", desc.name));
        !ok)
        return ok.error();

    VkBufferDeviceAddressInfo address = {VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO};
    address.buffer = handle;
    buffer.address = vkGetBufferDeviceAddress(device.handle, &address);

    if (hasTexels) {
        VkBufferViewCreateInfo view = {VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
        view.buffer = handle;
        view.format = desc.texelFormat;
        view.range = VK_WHOLE_SIZE;
        VkBufferView texels = VK_NULL_HANDLE;
        if (Result<void> ok = vkTry(vkCreateBufferView(device.handle, &view, nullptr, &texels),
                                    fmt::format("create a texel view of '{}'", desc.name));
            !ok)
            return ok.error();
        buffer.texels = UniqueBufferView(device.handle, texels);
        setName(device, VK_OBJECT_TYPE_BUFFER_VIEW, texels, desc.name);
    }
    return buffer;
}

} // namespace penumbra
