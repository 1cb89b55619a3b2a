// Compute and graphics pipelines from embedded shaders. One descriptor set (set 0), a second one
// (set 1) for what changes between the draws of a graphics pipeline, and one push constant block;
// specialisation constants choose variants.
#pragma once

#include "runtime/vk/descriptors.h"

#include <type_traits>

namespace penumbra {

constexpr std::uint32_t kMaxPushBytes = 128; // what every Vulkan device has

// Move-only.
struct Pipeline {
    std::string name;
    VkPipelineBindPoint bindPoint = VK_PIPELINE_BIND_POINT_COMPUTE;
    VkShaderStageFlags pushStages = 0;
    std::uint32_t pushBytes = 0;
    UniqueDescriptorSetLayout setLayout;     // null without bindings
    UniqueDescriptorSetLayout drawSetLayout; // of set 1; null without drawBindings
    UniquePipelineLayout layout;
    UniquePipeline handle;
};

struct ComputeDesc {
    std::string shader;                   // "combine.comp"; names the pipeline too
    std::vector<Binding> bindings;        // of set 0
    std::uint32_t pushBytes = 0;          // sizeof the push constant struct, <= kMaxPushBytes
    std::vector<std::uint32_t> constants; // constant_id 0, 1, …; bools and floats as their bits
};

enum class Blend { Off, Alpha /* source over, straight alpha */ };

struct GraphicsDesc {
    std::string name;
    std::string vertexShader;
    std::string fragmentShader; // empty: depth only
    std::vector<Binding> bindings;
    std::vector<Binding> drawBindings;    // of set 1; needs bindings
    std::uint32_t pushBytes = 0;          // seen by both stages
    std::vector<std::uint32_t> constants; // given to both stages

    std::vector<VkVertexInputBindingDescription> vertexBindings;
    std::vector<VkVertexInputAttributeDescription> vertexAttributes;
    VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;

    std::vector<VkFormat> colorFormats; // of the dynamic rendering it runs in
    VkFormat depthFormat = VK_FORMAT_UNDEFINED;
    VkCullModeFlags cull =
        VK_CULL_MODE_BACK_BIT; // front faces are counter-clockwise, see setViewport
    bool depthTest = true;     // ignored without a depth format
    bool depthWrite = true;
    VkCompareOp depthCompare = VK_COMPARE_OP_LESS_OR_EQUAL;
    Blend blend = Blend::Off; // of every colour target
};

// Errors: out of memory. Compiling takes 0.1-1.5 CPU-seconds on lavapipe; thread-safe.
Result<Pipeline> createComputePipeline(const Device& device, const ComputeDesc& desc);
Result<Pipeline> createGraphicsPipeline(const Device& device, const GraphicsDesc& desc);

// Binds pipeline, set (if any) and push constants. A null `push` needs pushBytes == 0.
void bind(VkCommandBuffer cmd, const Pipeline& pipeline, VkDescriptorSet set, const void* push,
          std::size_t pushBytes);

template <class Push>
void bindAndPush(VkCommandBuffer cmd, const Pipeline& pipeline, VkDescriptorSet set,
                 const Push& push)
{
    static_assert(std::is_trivially_copyable_v<Push> && sizeof(Push) <= kMaxPushBytes);
    bind(cmd, pipeline, set, &push, sizeof(Push));
}

template <class Push>
void bindAndPush(VkCommandBuffer cmd, const Pipeline& pipeline, const Push& push)
{
    bindAndPush(cmd, pipeline, VK_NULL_HANDLE, push);
}

// Binds set 1 for the draws that follow; the pipeline is bound.
void bindDrawSet(VkCommandBuffer cmd, const Pipeline& pipeline, VkDescriptorSet set);

// The whole target, Y up (negative viewport height): clip space +Y is the top row, and a triangle
// counter-clockwise seen with Y up is a front face.
void setViewport(VkCommandBuffer cmd, VkExtent2D extent);

// Workgroups that cover `items`.
[[nodiscard]] constexpr std::uint32_t groupCount(std::uint32_t items, std::uint32_t groupSize)
{
    return items / groupSize + (items % groupSize != 0 ? 1 : 0);
}

} // namespace penumbra
