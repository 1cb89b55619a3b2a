// A device with one queue that does graphics, compute and transfer: opened here, or lent by a host.
//   Result<Device> device = createDevice(*instance, {.choice = "llvmpipe"});
// Order of preference: discrete GPU, integrated, virtual, software.
#pragma once

#include "runtime/vk/features.h"
#include "runtime/vk/instance.h"
#include "runtime/vk/owned.h"

#include <atomic>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

namespace penumbra {

struct DeviceInfo {
    VkPhysicalDevice handle = VK_NULL_HANDLE;
    std::string name;   // "llvmpipe (LLVM 15.0.6, 256 bits)"
    std::string driver; // "llvmpipe Mesa 22.3.6 (LLVM 15.0.6)"
    VkPhysicalDeviceType type = VK_PHYSICAL_DEVICE_TYPE_OTHER;
    std::uint32_t queueFamily = 0;    // the family that Device::queue comes from
    std::vector<std::string> missing; // why it cannot be used; empty: it can
};

// All devices in order of preference, unusable ones too. With a surface, a device that cannot
// present to it is unusable. Error: there is no device at all.
Result<std::vector<DeviceInfo>> listDevices(const Instance& instance,
                                            VkSurfaceKHR surface = VK_NULL_HANDLE);

// Index into `devices`. `choice`: empty (the first usable one), an index, or part of a name in any
// case. Error: no such device, or every reason why it cannot be used.
Result<std::size_t> chooseDevice(std::span<const DeviceInfo> devices, const std::string& choice);

struct DeviceOptions {
    std::string choice;                    // see chooseDevice
    VkSurfaceKHR surface = VK_NULL_HANDLE; // set: must present to it, and swapchains work
};

struct AllocationCount {
    std::atomic<std::uint32_t> live = 0;
    std::uint32_t limit = 0; // maxMemoryAllocationCount
};

// Names and labels of VK_EXT_debug_utils; null where the extension is absent.
struct DebugFunctions {
    PFN_vkSetDebugUtilsObjectNameEXT setName = nullptr;
    PFN_vkCmdBeginDebugUtilsLabelEXT beginLabel = nullptr;
    PFN_vkCmdEndDebugUtilsLabelEXT endLabel = nullptr;
};

struct DestroyDevice {
    void operator()(VkDevice device) const; // waits for the GPU, then destroys
};

// Outlives everything made from it. Moves, but is not assigned to; what is made from it does not
// point at it.
struct Device {
    Device() = default;
    Device(Device&&) noexcept = default;
    Device& operator=(Device&&) = delete; // a live device would end before its cache

    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice handle = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE; // through submit(), or under *queueMutex
    std::uint32_t queueFamily = 0;

    VkPhysicalDeviceProperties properties = {};
    VkPhysicalDeviceMemoryProperties memory = {};
    std::string driver;
    Features features;                    // enabled, optional ones included
    std::uint32_t timestampValidBits = 0; // 0: no timestamps, zones report no times
    DebugFunctions debug;

    std::unique_ptr<VkDevice_T, DestroyDevice> owned; // null for a host's device
    UniquePipelineCache pipelineCache;                // shared by all pipelines of this process
    std::unique_ptr<std::mutex> queueMutex = std::make_unique<std::mutex>();
    std::shared_ptr<AllocationCount> allocations = std::make_shared<AllocationCount>();
};

Result<Device> createDevice(const Instance& instance, const DeviceOptions& options = {});

// A device that the host opened with at least requiredFeatures() enabled. The host keeps ownership,
// outlives ours, and does not use the queue while a call of ours that submits is running
// (submit, submitAndWait, uploads, read-backs, FrameRing::endFrame).
struct HostDevice {
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE; // graphics, compute and transfer
    std::uint32_t queueFamily = 0;
    bool debugUtils = false; // VK_EXT_debug_utils is enabled on the instance
};

// Error: every required feature that the physical device lacks.
Result<Device> adoptDevice(const HostDevice& host);

// Thread-safe. Error: device lost or out of memory.
Result<void> submit(const Device& device, const VkSubmitInfo2& info, VkFence fence = {});

// Names an object for validation messages and captures. No effect without debug utils.
void setObjectName(const Device& device, VkObjectType type, std::uint64_t handle,
                   const std::string& name);

template <class Handle>
void setName(const Device& device, VkObjectType type, Handle handle, const std::string& name)
{
    setObjectName(device, type, reinterpret_cast<std::uint64_t>(handle), name);
}

} // namespace penumbra
