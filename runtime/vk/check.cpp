#include "runtime/vk/check.h"

#include <array>
#include <fmt/format.h>

namespace penumbra {
namespace {

struct ResultText {
    VkResult result;
    const char* name;
    const char* remedy; // null: only a bug of ours, or a code that no caller treats as a failure
};

constexpr auto kOutOfMemory = "free memory, or choose fewer or smaller objects";
constexpr std::array kResults = {
    ResultText{VK_SUCCESS, "VK_SUCCESS", nullptr},
    ResultText{VK_NOT_READY, "VK_NOT_READY", nullptr},
    ResultText{VK_TIMEOUT, "VK_TIMEOUT", "the device did not answer; look for a hung driver"},
    ResultText{VK_INCOMPLETE, "VK_INCOMPLETE", nullptr},
    ResultText{VK_SUBOPTIMAL_KHR, "VK_SUBOPTIMAL_KHR", nullptr},
    ResultText{VK_ERROR_OUT_OF_DATE_KHR, "VK_ERROR_OUT_OF_DATE_KHR", nullptr},
    ResultText{VK_ERROR_OUT_OF_HOST_MEMORY, "VK_ERROR_OUT_OF_HOST_MEMORY", kOutOfMemory},
    ResultText{VK_ERROR_OUT_OF_DEVICE_MEMORY, "VK_ERROR_OUT_OF_DEVICE_MEMORY", kOutOfMemory},
    ResultText{VK_ERROR_TOO_MANY_OBJECTS, "VK_ERROR_TOO_MANY_OBJECTS", kOutOfMemory},
    ResultText{VK_ERROR_INITIALIZATION_FAILED, "VK_ERROR_INITIALIZATION_FAILED",
               "the driver could not start; try another device or update the driver"},
    ResultText{VK_ERROR_DEVICE_LOST, "VK_ERROR_DEVICE_LOST",
               "the GPU stopped; start again, and run with validation if it repeats"},
    ResultText{VK_ERROR_MEMORY_MAP_FAILED, "VK_ERROR_MEMORY_MAP_FAILED", kOutOfMemory},
    ResultText{VK_ERROR_LAYER_NOT_PRESENT, "VK_ERROR_LAYER_NOT_PRESENT", "install the layer"},
    ResultText{VK_ERROR_EXTENSION_NOT_PRESENT, "VK_ERROR_EXTENSION_NOT_PRESENT",
               "the driver or window system lacks an extension; update the driver"},
    ResultText{VK_ERROR_INCOMPATIBLE_DRIVER, "VK_ERROR_INCOMPATIBLE_DRIVER",
               "install a Vulkan 1.3 driver"},
    ResultText{VK_ERROR_SURFACE_LOST_KHR, "VK_ERROR_SURFACE_LOST_KHR", "open the window again"},
    ResultText{VK_ERROR_NATIVE_WINDOW_IN_USE_KHR, "VK_ERROR_NATIVE_WINDOW_IN_USE_KHR",
               "another swapchain draws to this window; close it first"},
    ResultText{VK_ERROR_FORMAT_NOT_SUPPORTED, "VK_ERROR_FORMAT_NOT_SUPPORTED", nullptr},
    ResultText{VK_ERROR_FEATURE_NOT_PRESENT, "VK_ERROR_FEATURE_NOT_PRESENT", nullptr},
    ResultText{VK_ERROR_FRAGMENTED_POOL, "VK_ERROR_FRAGMENTED_POOL", nullptr},
    ResultText{VK_ERROR_OUT_OF_POOL_MEMORY, "VK_ERROR_OUT_OF_POOL_MEMORY", nullptr},
    ResultText{VK_ERROR_UNKNOWN, "VK_ERROR_UNKNOWN", nullptr},
};

const ResultText* findResult(VkResult result)
{
    for (const ResultText& text : kResults)
        if (text.result == result)
            return &text;
    return nullptr;
}

} // namespace

std::string resultName(VkResult result)
{
    const ResultText* text = findResult(result);
    return text ? text->name : fmt::format("VkResult {}", static_cast<int>(result));
}

Result<void> vkTry(VkResult result, std::string_view what, const std::source_location& where)
{
    if (result == VK_SUCCESS)
        return {};
    if (const ResultText* text = findResult(result); text && text->remedy)
        return Error{fmt::format("cannot {}: {}; {}", what, text->name, text->remedy)};
    vkCheck(result, what, where);
    return {};
}

void vkCheck(VkResult result, std::string_view what, const std::source_location& where)
{
    if (result != VK_SUCCESS) [[unlikely]]
        failAssert("result == VK_SUCCESS", where.file_name(), static_cast<int>(where.line()),
                   fmt::format("cannot {}: {}", what, resultName(result)));
}

} // namespace penumbra
