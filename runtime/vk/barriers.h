// Synchronisation between passes on one queue. A memory barrier orders all buffers at once: passes
// reach buffers by address, which no buffer barrier could name.
#pragma once

#include <vulkan/vulkan.h>

namespace penumbra {

void memoryBarrier(VkCommandBuffer cmd, VkPipelineStageFlags2 srcStage, VkAccessFlags2 srcAccess,
                   VkPipelineStageFlags2 dstStage, VkAccessFlags2 dstAccess);

// What a compute shader wrote, and what may come next. Each also orders write after read.
void computeToCompute(VkCommandBuffer cmd);
void computeToIndirect(VkCommandBuffer cmd); // indirect arguments, and compute shaders
void computeToGraphics(VkCommandBuffer cmd); // indirect, vertex and index input, all shaders
void computeToTransfer(VkCommandBuffer cmd);
void transferToCompute(VkCommandBuffer cmd);
void transferToGraphics(VkCommandBuffer cmd); // indirect, vertex and index input, all shaders
void graphicsToCompute(VkCommandBuffer cmd);  // vertices read, attachments written: buffers free
void fullBarrier(VkCommandBuffer cmd);        // everything, the host's reads too

// One use of an image: layout, and who touches it how.
struct ImageUse {
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
    VkPipelineStageFlags2 stage = VK_PIPELINE_STAGE_2_NONE;
    VkAccessFlags2 access = VK_ACCESS_2_NONE;
};

// From kUndefinedImage the contents are lost, but earlier work is still waited for.
constexpr ImageUse kUndefinedImage = {VK_IMAGE_LAYOUT_UNDEFINED,
                                      VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_NONE};
constexpr ImageUse kColorTarget = {
    VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
    VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT};
constexpr ImageUse kDepthTarget = {
    VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT};
constexpr ImageUse kShaderRead = {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                  VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT |
                                      VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                  VK_ACCESS_2_SHADER_READ_BIT};
constexpr ImageUse kStorageImage = {VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                    VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_SHADER_WRITE_BIT};
constexpr ImageUse kCopySource = {VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                  VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                                  VK_ACCESS_2_TRANSFER_READ_BIT};
constexpr ImageUse kCopyTarget = {VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                  VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                                  VK_ACCESS_2_TRANSFER_WRITE_BIT};
// A swapchain image, before and after the frame. The acquire semaphore waits at ALL_COMMANDS.
constexpr ImageUse kPresent = {VK_IMAGE_LAYOUT_PRESENT_SRC_KHR,
                               VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_NONE};

void transitionImage(VkCommandBuffer cmd, VkImage image, VkImageAspectFlags aspect,
                     const ImageUse& from, const ImageUse& to);

} // namespace penumbra
