#include "runtime/vk/features.h"

#include <fmt/format.h>
#include <iterator>

namespace penumbra {
namespace {

struct Row {
    const char* name;
    const char* reason;
    VkBool32& (*bit)(Features& features);
};

#define PENUMBRA_FEATURE(part, field, reason)                                                      \
    Row                                                                                            \
    {                                                                                              \
#field, reason, [](Features & features) -> VkBool32& { return features.part.field; }       \
    }

constexpr Row kRequired[] = {
    PENUMBRA_FEATURE(core, drawIndirectFirstInstance,
                     "an instance's constants are found by its index"),
    PENUMBRA_FEATURE(v12, bufferDeviceAddress, "passes reach their buffers by address"),
    PENUMBRA_FEATURE(v12, scalarBlockLayout, "C++ and GLSL share the same structs"),
    PENUMBRA_FEATURE(v12, timelineSemaphore, "frames in flight are counted on a timeline"),
    PENUMBRA_FEATURE(v12, hostQueryReset, "the frame ring resets its timestamps"),
    PENUMBRA_FEATURE(v13, dynamicRendering, "rasterising without render pass objects"),
    PENUMBRA_FEATURE(v13, synchronization2, "barriers and submits"),
    PENUMBRA_FEATURE(v13, maintenance4, "workgroup sizes by specialisation constant"),
};

// Enabled where present; Device::features says so. Whoever uses one has a way without it.
constexpr Row kOptional[] = {
    PENUMBRA_FEATURE(core, multiDrawIndirect, "many meshes in one indirect draw"),
    PENUMBRA_FEATURE(core, fillModeNonSolid, "wireframe views"),
    PENUMBRA_FEATURE(core, samplerAnisotropy, "textures"),
    PENUMBRA_FEATURE(v12, drawIndirectCount, "draw counts written by the GPU"),
};

#undef PENUMBRA_FEATURE

Features supportedFeatures(VkPhysicalDevice physical)
{
    Features features;
    VkPhysicalDeviceFeatures2 chain = chainFeatures(features);
    vkGetPhysicalDeviceFeatures2(physical, &chain);
    features.core = chain.features;
    return features;
}

} // namespace

Features requiredFeatures()
{
    Features features;
    for (const Row& row : kRequired)
        row.bit(features) = VK_TRUE;
    return features;
}

Features usableFeatures(VkPhysicalDevice physical)
{
    Features supported = supportedFeatures(physical);
    Features features = requiredFeatures();
    for (const Row& row : kOptional)
        row.bit(features) = row.bit(supported);
    return features;
}

std::vector<std::string> missingFeatures(VkPhysicalDevice physical)
{
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(physical, &properties);
    if (properties.apiVersion < VK_API_VERSION_1_3) // its feature structs cannot be asked for
        return {fmt::format("Vulkan 1.3 (it has {}.{})",
                            VK_API_VERSION_MAJOR(properties.apiVersion),
                            VK_API_VERSION_MINOR(properties.apiVersion))};
    Features supported = supportedFeatures(physical);
    std::vector<std::string> missing;
    for (const Row& row : kRequired)
        if (!row.bit(supported))
            missing.push_back(fmt::format("{} ({})", row.name, row.reason));
    return missing;
}

VkPhysicalDeviceFeatures2 chainFeatures(Features& features)
{
    features.v11.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES;
    features.v12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    features.v13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
    features.v11.pNext = &features.v12;
    features.v12.pNext = &features.v13;
    features.v13.pNext = nullptr;
    VkPhysicalDeviceFeatures2 chain = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    chain.pNext = &features.v11;
    chain.features = features.core;
    return chain;
}

} // namespace penumbra
