#include "runtime/vk/device.h"

namespace penumbra {
namespace {

std::vector<VkQueueFamilyProperties> queueFamilies(VkPhysicalDevice physical)
{
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    return families;
}

template <class Function>
Function deviceFunction(VkInstance instance, const char* name)
{
    return reinterpret_cast<Function>(vkGetInstanceProcAddr(instance, name));
}

// What an opened and an adopted device have in common: everything that can be asked for.
Device describe(VkInstance instance, VkPhysicalDevice physical, VkDevice handle, VkQueue queue,
                std::uint32_t queueFamily, bool debugUtils)
{
    Device device;
    device.instance = instance;
    device.physical = physical;
    device.handle = handle;
    device.queue = queue;
    device.queueFamily = queueFamily;

    VkPhysicalDeviceDriverProperties driver = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    properties.pNext = &driver;
    vkGetPhysicalDeviceProperties2(physical, &properties);
    vkGetPhysicalDeviceMemoryProperties(physical, &device.memory);
    device.properties = properties.properties;
    device.driver = fmt::format("{} {}", driver.driverName, driver.driverInfo);
    device.allocations->limit = device.properties.limits.maxMemoryAllocationCount;
    device.timestampValidBits = queueFamilies(physical).at(queueFamily).timestampValidBits;

    if (debugUtils) {
        device.debug.setName = deviceFunction<PFN_vkSetDebugUtilsObjectNameEXT>(
            instance, "vkSetDebugUtilsObjectNameEXT");
        device.debug.beginLabel = deviceFunction<PFN_vkCmdBeginDebugUtilsLabelEXT>(
            instance, "vkCmdBeginDebugUtilsLabelEXT");
        device.debug.endLabel =
            deviceFunction<PFN_vkCmdEndDebugUtilsLabelEXT>(instance, "vkCmdEndDebugUtilsLabelEXT");
    }
    return device;
}

Result<void> createCache(Device& device)
{
    const VkPipelineCacheCreateInfo info = {VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    VkPipelineCache cache = VK_NULL_HANDLE;
    Result<void> ok = vkTry(vkCreatePipelineCache(device.handle, &info, nullptr, &cache),
                            "create a pipeline cache");
    device.pipelineCache = UniquePipelineCache(device.handle, cache);
    return ok;
}

} // namespace

Result<Device> createDevice(const Instance& instance, const DeviceOptions& options)
{
    const Result<std::vector<DeviceInfo>> devices = listDevices(instance, options.surface);
    if (!devices)
        return devices.error();
    const Result<std::size_t> index = chooseDevice(*devices, options.choice);
    if (!index)
        return index.error();
    const DeviceInfo& chosen = (*devices)[*index];

    Features features = usableFeatures(chosen.handle);
    const VkPhysicalDeviceFeatures2 chain = chainFeatures(features);
    const float priority = 1;
    VkDeviceQueueCreateInfo queueInfo = {VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queueInfo.queueFamilyIndex = chosen.queueFamily;
    queueInfo.queueCount = 1;
    queueInfo.pQueuePriorities = &priority;
    const char* const swapchain = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    VkDeviceCreateInfo info = {VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
    info.pNext = &chain;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queueInfo;
    info.enabledExtensionCount = options.surface != VK_NULL_HANDLE ? 1 : 0;
    info.ppEnabledExtensionNames = &swapchain;

    VkDevice handle = VK_NULL_HANDLE;
    const VkResult created = vkCreateDevice(chosen.handle, &info, nullptr, &handle);
    if (Result<void> ok = vkTry(created, fmt::format("open the device '{}'", chosen.name)); !ok)
        return ok.error();
    VkQueue queue = VK_NULL_HANDLE;
    vkGetDeviceQueue(handle, chosen.queueFamily, 0, &queue);

    Device device = describe(instance.handle, chosen.handle, handle, queue, chosen.queueFamily,
                             instance.debugUtils);
    device.owned.reset(handle);
    device.features = features;
    if (Result<void> ok = createCache(device); !ok)
        return ok.error();
    return device;
}

Result<Device> adoptDevice(const HostDevice& host)
{
    PENUMBRA_ASSERT(host.instance && host.physical && host.device && host.queue,
                    "a host device with all its handles");
    const std::vector<std::string> missing = missingFeatures(host.physical);
    if (!missing.empty())
        return Error{
            fmt::format("the host's device lacks {}; lend another one", fmt::join(missing, ", "))};
    Device device = describe(host.instance, host.physical, host.device, host.queue,
                             host.queueFamily, host.debugUtils);
    device.features = requiredFeatures();
    if (Result<void> ok = createCache(device); !ok)
        return ok.error();
    return device;
}

void DestroyDevice::operator()(VkDevice device) const
{
    vkDeviceWaitIdle(device); // a lost device is idle too: nothing to do about the result
    vkDestroyDevice(device, nullptr);
}

Result<void> submit(const Device& device, const VkSubmitInfo2& info, VkFence fence)
{
    const std::lock_guard lock(*device.queueMutex);
    return vkTry(vkQueueSubmit2(device.queue, 1, &info, fence), "submit work to the GPU");
}

void setObjectName(const Device& device, VkObjectType type, std::uint64_t handle,
                   const std::string& name)
{
    if (!device.debug.setName)
        return;
    VkDebugUtilsObjectNameInfoEXT info = {VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
    info.objectType = type;
    info.objectHandle = handle;
    info.pObjectName = name.c_str();
    vkCheck(device.debug.setName(device.handle, &info), "name an object");
}

} // namespace penumbra
