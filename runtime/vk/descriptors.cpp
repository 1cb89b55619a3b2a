#include "runtime/vk/descriptors.h"

namespace penumbra {
namespace {

constexpr std::uint32_t kSetsPerPool = 64; // a frame's few dozen passes fit in one pool

UniqueDescriptorPool createPool(VkDevice device)
{
    // Of each type, as many as 64 sets of typical passes need; a set with more gets its own share
    // of the next pool.
    constexpr VkDescriptorPoolSize kSizes[] = {
        {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, 4 * kSetsPerPool},
        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 4 * kSetsPerPool},
        {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, kSetsPerPool},
        {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 2 * kSetsPerPool},
        {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 2 * kSetsPerPool},
    };
    VkDescriptorPoolCreateInfo info = {VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    info.maxSets = kSetsPerPool;
    info.poolSizeCount = std::size(kSizes);
    info.pPoolSizes = kSizes;
    VkDescriptorPool pool = VK_NULL_HANDLE;
    vkCheck(vkCreateDescriptorPool(device, &info, nullptr, &pool), "create a descriptor pool");
    return {device, pool};
}

} // namespace

UniqueDescriptorSetLayout createSetLayout(const Device& device, std::span<const Binding> bindings)
{
    std::vector<VkDescriptorSetLayoutBinding> slots;
    for (const Binding& binding : bindings)
        slots.push_back({binding.binding, binding.type, 1, binding.stages, nullptr});
    VkDescriptorSetLayoutCreateInfo info = {VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    info.bindingCount = static_cast<std::uint32_t>(slots.size());
    info.pBindings = slots.data();
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    vkCheck(vkCreateDescriptorSetLayout(device.handle, &info, nullptr, &layout),
            "create a descriptor set layout");
    return {device.handle, layout};
}

VkDescriptorSet DescriptorSets::allocate(VkDescriptorSetLayout layout)
{
    PENUMBRA_ASSERT(m_device && layout, "a pool with a device, and a layout");
    bool fresh = false;
    while (true) {
        if (m_current == m_pools.size()) {
            m_pools.push_back(createPool(m_device));
            fresh = true;
        }
        const VkDescriptorPool pool = m_pools[m_current];
        VkDescriptorSetAllocateInfo info = {VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
        info.descriptorPool = pool;
        info.descriptorSetCount = 1;
        info.pSetLayouts = &layout;
        VkDescriptorSet set = VK_NULL_HANDLE;
        const VkResult result = vkAllocateDescriptorSets(m_device, &info, &set);
        const bool full =
            result == VK_ERROR_OUT_OF_POOL_MEMORY || result == VK_ERROR_FRAGMENTED_POOL;
        if (!full || fresh) { // a set that an empty pool cannot hold is a bug
            vkCheck(result, "allocate a descriptor set");
            return set;
        }
        ++m_current;
    }
}

void DescriptorSets::reset()
{
    for (const UniqueDescriptorPool& pool : m_pools)
        vkCheck(vkResetDescriptorPool(m_device, pool, 0), "reset a descriptor pool");
    m_current = 0;
}

DescriptorWriter::DescriptorWriter(const Device& device, VkDescriptorSet set)
    : m_device(device.handle), m_set(set)
{}

VkWriteDescriptorSet& DescriptorWriter::add(std::uint32_t binding, VkDescriptorType type)
{
    VkWriteDescriptorSet& write = m_writes.emplace_back();
    write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    write.dstSet = m_set;
    write.dstBinding = binding;
    write.descriptorCount = 1;
    write.descriptorType = type;
    return write;
}

DescriptorWriter& DescriptorWriter::storageBuffer(std::uint32_t binding, VkBuffer buffer)
{
    add(binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER).pBufferInfo =
        &m_buffers.emplace_back(VkDescriptorBufferInfo{buffer, 0, VK_WHOLE_SIZE});
    return *this;
}

DescriptorWriter& DescriptorWriter::uniformBuffer(std::uint32_t binding, VkBuffer buffer)
{
    add(binding, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER).pBufferInfo =
        &m_buffers.emplace_back(VkDescriptorBufferInfo{buffer, 0, VK_WHOLE_SIZE});
    return *this;
}

DescriptorWriter& DescriptorWriter::texels(std::uint32_t binding, VkBufferView view)
{
    add(binding, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER).pTexelBufferView =
        &m_views.emplace_back(view);
    return *this;
}

DescriptorWriter& DescriptorWriter::storageImage(std::uint32_t binding, VkImageView view)
{
    add(binding, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE).pImageInfo = &m_images.emplace_back(
        VkDescriptorImageInfo{VK_NULL_HANDLE, view, VK_IMAGE_LAYOUT_GENERAL});
    return *this;
}

DescriptorWriter& DescriptorWriter::sampledImage(std::uint32_t binding, VkImageView view,
                                                 VkSampler sampler)
{
    add(binding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER).pImageInfo = &m_images.emplace_back(
        VkDescriptorImageInfo{sampler, view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
    return *this;
}

void DescriptorWriter::write()
{
    vkUpdateDescriptorSets(m_device, static_cast<std::uint32_t>(m_writes.size()), m_writes.data(),
                           0, nullptr);
    m_writes.clear();
}

} // namespace penumbra
