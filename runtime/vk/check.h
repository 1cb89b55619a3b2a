// Every VkResult passes through one of these, in release builds too.
//   vkTry    for calls that may fail although the program is right (memory, device lost, surface
//            lost): those results become an Error; any other failure is a bug and asserts.
//   vkCheck  for calls whose failure cannot be handled: anything but VK_SUCCESS asserts.
// `what` completes "cannot …": vkTry(vkCreateBuffer(…), "create buffer 'radiance'").
#pragma once

#include "runtime/result.h"

#include <source_location>
#include <string>
#include <string_view>
#include <vulkan/vulkan.h>

namespace penumbra {

[[nodiscard]] std::string resultName(VkResult result); // "VK_ERROR_DEVICE_LOST"

[[nodiscard]] Result<void>
vkTry(VkResult result, std::string_view what,
      const std::source_location& where = std::source_location::current());

void vkCheck(VkResult result, std::string_view what,
             const std::source_location& where = std::source_location::current());

} // namespace penumbra
