// Listing and choosing devices: see device.h.
#include "runtime/vk/device.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <optional>

namespace penumbra {
namespace {

int preference(VkPhysicalDeviceType type)
{
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return 0;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return 1;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return 2;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return 3;
    default:
        return 4;
    }
}

// A family that does graphics and compute (and so transfer), and presents if there is a surface.
std::optional<std::uint32_t> findQueueFamily(VkPhysicalDevice physical, VkSurfaceKHR surface)
{
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    for (std::uint32_t i = 0; i < count; ++i) {
        constexpr VkQueueFlags kNeeded = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
        if ((families[i].queueFlags & kNeeded) != kNeeded)
            continue;
        VkBool32 presents = VK_TRUE;
        if (surface != VK_NULL_HANDLE &&
            vkGetPhysicalDeviceSurfaceSupportKHR(physical, i, surface, &presents) != VK_SUCCESS)
            presents = VK_FALSE;
        if (presents)
            return i;
    }
    return std::nullopt;
}

bool hasSwapchain(VkPhysicalDevice physical)
{
    std::uint32_t count = 0;
    vkCheck(vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, nullptr),
            "count device extensions");
    std::vector<VkExtensionProperties> extensions(count);
    vkCheck(vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, extensions.data()),
            "list device extensions");
    return std::any_of(extensions.begin(), extensions.end(), [](const VkExtensionProperties& e) {
        return std::strcmp(e.extensionName, VK_KHR_SWAPCHAIN_EXTENSION_NAME) == 0;
    });
}

DeviceInfo describe(VkPhysicalDevice physical, VkSurfaceKHR surface)
{
    VkPhysicalDeviceDriverProperties driver = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    VkPhysicalDeviceProperties basic;
    vkGetPhysicalDeviceProperties(physical, &basic);
    if (basic.apiVersion >= VK_API_VERSION_1_2) // the driver's name is a question of 1.2
        properties.pNext = &driver;
    vkGetPhysicalDeviceProperties2(physical, &properties);

    DeviceInfo info;
    info.handle = physical;
    info.name = basic.deviceName;
    info.driver = fmt::format("{} {}", driver.driverName, driver.driverInfo);
    info.type = basic.deviceType;
    info.missing = missingFeatures(physical);
    const std::optional<std::uint32_t> family = findQueueFamily(physical, surface);
    info.queueFamily = family.value_or(0);
    if (!family)
        info.missing.emplace_back(
            surface ? "a queue for graphics and compute that presents to the window"
                    : "a queue for graphics and compute");
    if (surface != VK_NULL_HANDLE && !hasSwapchain(physical))
        info.missing.emplace_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
    return info;
}

std::string lower(std::string text)
{
    for (char& c : text)
        if (c >= 'A' && c <= 'Z')
            c = static_cast<char>(c - 'A' + 'a');
    return text;
}

// "  0: llvmpipe (…)" or "  1: old card, lacks Vulkan 1.3 (it has 1.1)", one line each
std::string listing(std::span<const DeviceInfo> devices)
{
    std::string text;
    for (std::size_t i = 0; i < devices.size(); ++i) {
        text += fmt::format("\n  {}: {}", i, devices[i].name);
        if (!devices[i].missing.empty())
            text += fmt::format(", lacks {}", fmt::join(devices[i].missing, ", "));
    }
    return text;
}

} // namespace

Result<std::vector<DeviceInfo>> listDevices(const Instance& instance, VkSurfaceKHR surface)
{
    std::uint32_t count = 0;
    VkResult result = vkEnumeratePhysicalDevices(instance.handle, &count, nullptr);
    if (count == 0 || result == VK_ERROR_INITIALIZATION_FAILED)
        return noDeviceError();
    std::vector<VkPhysicalDevice> handles(count);
    if (result == VK_SUCCESS)
        result = vkEnumeratePhysicalDevices(instance.handle, &count, handles.data());
    if (Result<void> ok = vkTry(result, "list Vulkan devices"); !ok)
        return ok.error();

    std::vector<DeviceInfo> devices;
    for (const VkPhysicalDevice handle : handles)
        devices.push_back(describe(handle, surface));
    std::stable_sort(devices.begin(), devices.end(), [](const DeviceInfo& a, const DeviceInfo& b) {
        return preference(a.type) < preference(b.type);
    });
    return devices;
}

Result<std::size_t> chooseDevice(std::span<const DeviceInfo> devices, const std::string& choice)
{
    std::size_t index = 0;
    const char* const end = choice.data() + choice.size();
    const std::from_chars_result number = std::from_chars(choice.data(), end, index);
    if (choice.empty()) {
        index = 0;
        while (index < devices.size() && !devices[index].missing.empty())
            ++index;
        if (index == devices.size())
            return Error{fmt::format("no usable Vulkan device; update a driver, or install the "
                                     "software device (Debian: apt install mesa-vulkan-drivers):{}",
                                     listing(devices))};
    } else if (number.ec != std::errc() || number.ptr != end) {
        index = 0;
        while (index < devices.size() &&
               lower(devices[index].name).find(lower(choice)) == std::string::npos)
            ++index;
    }
    if (index >= devices.size())
        return Error{fmt::format("no device '{}'; choose one of:{}", choice, listing(devices))};
    if (!devices[index].missing.empty())
        return Error{fmt::format("device '{}' lacks {}; choose another of:{}", devices[index].name,
                                 fmt::join(devices[index].missing, ", "), listing(devices))};
    return index;
}

} // namespace penumbra
