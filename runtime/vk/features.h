// Which Vulkan features Penumbra uses: one table in features.cpp, with a reason for each.
#pragma once

#include <string>
#include <vector>
#include <vulkan/vulkan.h>

namespace penumbra {

struct Features {
    VkPhysicalDeviceFeatures core = {};
    VkPhysicalDeviceVulkan11Features v11 = {};
    VkPhysicalDeviceVulkan12Features v12 = {};
    VkPhysicalDeviceVulkan13Features v13 = {};
};

// What a host enables when it makes the device itself (see HostDevice): exactly the required bits.
[[nodiscard]] Features requiredFeatures();

// The required bits and those optional ones that `physical` supports: what createDevice enables.
[[nodiscard]] Features usableFeatures(VkPhysicalDevice physical);

// One line per required feature that is absent: "scalarBlockLayout (C++ and GLSL share structs)".
[[nodiscard]] std::vector<std::string> missingFeatures(VkPhysicalDevice physical);

// A pNext chain over `features` for vkCreateDevice; lives as long as `features` stays in place.
[[nodiscard]] VkPhysicalDeviceFeatures2 chainFeatures(Features& features);

} // namespace penumbra
