// Descriptor sets, for what a device address cannot reach: texel buffers, images, samplers.
//   VkDescriptorSet set = sets.allocate(pipeline.setLayout);
//   DescriptorWriter(device, set).texels(0, fields.texels).storageImage(1, target.view).write();
#pragma once

#include "runtime/vk/device.h"

#include <deque>

namespace penumbra {

struct Binding {
    std::uint32_t binding = 0;
    VkDescriptorType type = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
    VkShaderStageFlags stages = VK_SHADER_STAGE_COMPUTE_BIT;
};

[[nodiscard]] UniqueDescriptorSetLayout createSetLayout(const Device& device,
                                                        std::span<const Binding> bindings);

// A growing pool. All its sets end together, at reset() or with it. One thread at a time.
// Move-only.
class DescriptorSets {
public:
    DescriptorSets() = default;
    explicit DescriptorSets(const Device& device) : m_device(device.handle) {}

    // A set of one pipeline may be bound to any other whose bindings are the same.
    [[nodiscard]] VkDescriptorSet allocate(VkDescriptorSetLayout layout);
    void reset(); // the GPU no longer uses any of the sets

private:
    VkDevice m_device = VK_NULL_HANDLE;
    std::vector<UniqueDescriptorPool> m_pools;
    std::size_t m_current = 0;
};

// Collects writes to one set; write() carries them out. The objects outlive the set's use.
class DescriptorWriter {
public:
    DescriptorWriter(const Device& device, VkDescriptorSet set);

    DescriptorWriter& storageBuffer(std::uint32_t binding, VkBuffer buffer);
    DescriptorWriter& uniformBuffer(std::uint32_t binding, VkBuffer buffer);
    DescriptorWriter& texels(std::uint32_t binding, VkBufferView view);
    DescriptorWriter& storageImage(std::uint32_t binding, VkImageView view); // in layout GENERAL
    DescriptorWriter& sampledImage(std::uint32_t binding, VkImageView view, VkSampler sampler);
    void write();

private:
    VkWriteDescriptorSet& add(std::uint32_t binding, VkDescriptorType type);

    VkDevice m_device;
    VkDescriptorSet m_set;
    std::vector<VkWriteDescriptorSet> m_writes;
    std::deque<VkDescriptorBufferInfo> m_buffers; // deques: the writes point into them
    std::deque<VkDescriptorImageInfo> m_images;
    std::deque<VkBufferView> m_views;
};

} // namespace penumbra
