// Owned<Handle, vkDestroy…>: a Vulkan handle that destroys itself; move-only, converts to Handle.
// It does not wait for the GPU: what a frame may still use goes to FrameRing::retire.
// Move assignment swaps, so that a struct of several Owned fields, moved over a live one, hands all
// old handles to the source, which destroys them in the right (reverse) order.
#pragma once

#include <utility>
#include <vulkan/vulkan.h>

namespace penumbra {

template <class Handle, auto destroy>
class Owned {
public:
    Owned() = default;
    Owned(VkDevice device, Handle handle) : m_device(device), m_handle(handle) {}
    Owned(Owned&& other) noexcept
        : m_device(other.m_device), m_handle(std::exchange(other.m_handle, Handle{}))
    {}
    Owned& operator=(Owned&& other) noexcept
    {
        std::swap(m_device, other.m_device);
        std::swap(m_handle, other.m_handle);
        return *this;
    }
    ~Owned()
    {
        if (m_handle)
            destroy(m_device, m_handle, nullptr);
    }

    operator Handle() const { return m_handle; }
    [[nodiscard]] VkDevice device() const { return m_device; }

private:
    VkDevice m_device = VK_NULL_HANDLE;
    Handle m_handle = {};
};

using UniqueBuffer = Owned<VkBuffer, vkDestroyBuffer>;
using UniqueBufferView = Owned<VkBufferView, vkDestroyBufferView>;
using UniqueCommandPool = Owned<VkCommandPool, vkDestroyCommandPool>;
using UniqueDescriptorPool = Owned<VkDescriptorPool, vkDestroyDescriptorPool>;
using UniqueDescriptorSetLayout = Owned<VkDescriptorSetLayout, vkDestroyDescriptorSetLayout>;
using UniqueFence = Owned<VkFence, vkDestroyFence>;
using UniqueImage = Owned<VkImage, vkDestroyImage>;
using UniqueImageView = Owned<VkImageView, vkDestroyImageView>;
using UniqueMemory = Owned<VkDeviceMemory, vkFreeMemory>;
using UniquePipeline = Owned<VkPipeline, vkDestroyPipeline>;
using UniquePipelineCache = Owned<VkPipelineCache, vkDestroyPipelineCache>;
using UniquePipelineLayout = Owned<VkPipelineLayout, vkDestroyPipelineLayout>;
using UniqueQueryPool = Owned<VkQueryPool, vkDestroyQueryPool>;
using UniqueSampler = Owned<VkSampler, vkDestroySampler>;
using UniqueSemaphore = Owned<VkSemaphore, vkDestroySemaphore>;
using UniqueShaderModule = Owned<VkShaderModule, vkDestroyShaderModule>;

} // namespace penumbra
