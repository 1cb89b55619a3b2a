#include "runtime/vk/barriers.h"

namespace penumbra {
namespace {

constexpr VkPipelineStageFlags2 kCompute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
constexpr VkPipelineStageFlags2 kTransfer = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
constexpr VkAccessFlags2 kShaderReadWrite =
    VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_SHADER_WRITE_BIT | VK_ACCESS_2_UNIFORM_READ_BIT;
constexpr VkAccessFlags2 kTransferReadWrite =
    VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT;

// Where a draw reads what earlier passes wrote.
constexpr VkPipelineStageFlags2 kDraw =
    VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT |
    VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
constexpr VkAccessFlags2 kDrawRead = VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT |
                                     VK_ACCESS_2_INDEX_READ_BIT |
                                     VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT | kShaderReadWrite;

} // namespace

void memoryBarrier(VkCommandBuffer cmd, VkPipelineStageFlags2 srcStage, VkAccessFlags2 srcAccess,
                   VkPipelineStageFlags2 dstStage, VkAccessFlags2 dstAccess)
{
    VkMemoryBarrier2 barrier = {VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    barrier.srcStageMask = srcStage;
    barrier.srcAccessMask = srcAccess;
    barrier.dstStageMask = dstStage;
    barrier.dstAccessMask = dstAccess;
    VkDependencyInfo info = {VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(cmd, &info);
}

void computeToCompute(VkCommandBuffer cmd)
{
    memoryBarrier(cmd, kCompute, VK_ACCESS_2_SHADER_WRITE_BIT, kCompute, kShaderReadWrite);
}

void computeToIndirect(VkCommandBuffer cmd)
{
    memoryBarrier(cmd, kCompute, VK_ACCESS_2_SHADER_WRITE_BIT,
                  kCompute | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT,
                  kShaderReadWrite | VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT);
}

void computeToGraphics(VkCommandBuffer cmd)
{
    memoryBarrier(cmd, kCompute, VK_ACCESS_2_SHADER_WRITE_BIT, kDraw, kDrawRead);
}

void computeToTransfer(VkCommandBuffer cmd)
{
    memoryBarrier(cmd, kCompute, VK_ACCESS_2_SHADER_WRITE_BIT, kTransfer, kTransferReadWrite);
}

void transferToCompute(VkCommandBuffer cmd)
{
    memoryBarrier(cmd, kTransfer, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                  kCompute | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT,
                  kShaderReadWrite | VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT);
}

void transferToGraphics(VkCommandBuffer cmd)
{
    memoryBarrier(cmd, kTransfer, VK_ACCESS_2_TRANSFER_WRITE_BIT, kDraw, kDrawRead);
}

void graphicsToCompute(VkCommandBuffer cmd)
{
    memoryBarrier(cmd, VK_PIPELINE_STAGE_2_ALL_GRAPHICS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT, kCompute,
                  kShaderReadWrite);
}

void fullBarrier(VkCommandBuffer cmd)
{
    constexpr VkAccessFlags2 kAll = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    memoryBarrier(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_HOST_BIT,
                  kAll | VK_ACCESS_2_HOST_READ_BIT);
}

void transitionImage(VkCommandBuffer cmd, VkImage image, VkImageAspectFlags aspect,
                     const ImageUse& from, const ImageUse& to)
{
    VkImageMemoryBarrier2 barrier = {VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    barrier.srcStageMask = from.stage;
    barrier.srcAccessMask = from.access;
    barrier.dstStageMask = to.stage;
    barrier.dstAccessMask = to.access;
    barrier.oldLayout = from.layout;
    barrier.newLayout = to.layout;
    barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = {aspect, 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS};
    VkDependencyInfo info = {VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.imageMemoryBarrierCount = 1;
    info.pImageMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(cmd, &info);
}

} // namespace penumbra
