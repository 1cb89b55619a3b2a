#include "runtime/vk/pipeline.h"

#include "runtime/vk/shader_code.h"

#include <array>

namespace penumbra {
namespace {

UniqueShaderModule createModule(const Device& device, const std::string& shader)
{
    const std::span<const std::uint32_t> code = shaderCode(shader);
    VkShaderModuleCreateInfo info = {VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = code.size_bytes();
    info.pCode = code.data();
    VkShaderModule module = VK_NULL_HANDLE;
    vkCheck(vkCreateShaderModule(device.handle, &info, nullptr, &module), "load shader " + shader);
    setName(device, VK_OBJECT_TYPE_SHADER_MODULE, module, shader);
    return {device.handle, module};
}

// constant_id i is the i-th word. Points at `constants`.
class Specialisation {
public:
    explicit Specialisation(const std::vector<std::uint32_t>& constants)
    {
        for (std::uint32_t i = 0; i < constants.size(); ++i)
            m_entries.push_back({i, i * 4, 4});
        m_info.mapEntryCount = static_cast<std::uint32_t>(m_entries.size());
        m_info.pMapEntries = m_entries.data();
        m_info.dataSize = constants.size() * 4;
        m_info.pData = constants.data();
    }
    Specialisation(const Specialisation&) = delete;
    Specialisation& operator=(const Specialisation&) = delete;

    [[nodiscard]] const VkSpecializationInfo* info() const { return &m_info; }

private:
    std::vector<VkSpecializationMapEntry> m_entries;
    VkSpecializationInfo m_info = {};
};

VkPipelineShaderStageCreateInfo stageInfo(VkShaderStageFlagBits stage, VkShaderModule module,
                                          const Specialisation& constants)
{
    VkPipelineShaderStageCreateInfo info = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
    info.stage = stage;
    info.module = module;
    info.pName = "main";
    info.pSpecializationInfo = constants.info();
    return info;
}

// Everything but the VkPipeline itself.
Pipeline createLayout(const Device& device, const std::string& name, VkPipelineBindPoint bindPoint,
                      VkShaderStageFlags pushStages, std::uint32_t pushBytes,
                      std::span<const Binding> bindings, std::span<const Binding> drawBindings = {})
{
    PENUMBRA_ASSERT(pushBytes <= kMaxPushBytes && pushBytes % 4 == 0, "'{}' pushes {} bytes", name,
                    pushBytes);
    Pipeline pipeline;
    pipeline.name = name;
    pipeline.bindPoint = bindPoint;
    pipeline.pushStages = pushStages;
    pipeline.pushBytes = pushBytes;
    if (!bindings.empty())
        pipeline.setLayout = createSetLayout(device, bindings);
    PENUMBRA_ASSERT(drawBindings.empty() || pipeline.setLayout, "'{}' has set 1 and no set 0",
                    name);
    if (!drawBindings.empty())
        pipeline.drawSetLayout = createSetLayout(device, drawBindings);

    const VkDescriptorSetLayout setLayouts[] = {pipeline.setLayout, pipeline.drawSetLayout};
    const VkPushConstantRange range = {pushStages, 0, pushBytes};
    VkPipelineLayoutCreateInfo info = {VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    info.setLayoutCount = (setLayouts[0] ? 1u : 0u) + (setLayouts[1] ? 1u : 0u);
    info.pSetLayouts = setLayouts;
    info.pushConstantRangeCount = pushBytes > 0 ? 1 : 0;
    info.pPushConstantRanges = &range;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    vkCheck(vkCreatePipelineLayout(device.handle, &info, nullptr, &layout),
            "create the layout of " + name);
    pipeline.layout = UniquePipelineLayout(device.handle, layout);
    return pipeline;
}

Result<Pipeline> finish(const Device& device, Pipeline pipeline, VkResult result, VkPipeline handle)
{
    if (Result<void> ok = vkTry(result, fmt::format("create pipeline '{}'", pipeline.name)); !ok)
        return ok.error();
    pipeline.handle = UniquePipeline(device.handle, handle);
    setName(device, VK_OBJECT_TYPE_PIPELINE, handle, pipeline.name);
    return pipeline;
}

VkPipelineColorBlendAttachmentState blendState(Blend blend)
{
    VkPipelineColorBlendAttachmentState state = {};
    state.blendEnable = blend == Blend::Alpha;
    state.srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
    state.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    state.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    state.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    state.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT |
                           VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    return state;
}

} // namespace

Result<Pipeline> createComputePipeline(const Device& device, const ComputeDesc& desc)
{
    Pipeline pipeline = createLayout(device, desc.shader, VK_PIPELINE_BIND_POINT_COMPUTE,
                                     VK_SHADER_STAGE_COMPUTE_BIT, desc.pushBytes, desc.bindings);
    const UniqueShaderModule module = createModule(device, desc.shader);
    const Specialisation constants(desc.constants);
    VkComputePipelineCreateInfo info = {VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.stage = stageInfo(VK_SHADER_STAGE_COMPUTE_BIT, module, constants);
    info.layout = pipeline.layout;
    VkPipeline handle = VK_NULL_HANDLE;
    const VkResult result =
        vkCreateComputePipelines(device.handle, device.pipelineCache, 1, &info, nullptr, &handle);
    return finish(device, std::move(pipeline), result, handle);
}

Result<Pipeline> createGraphicsPipeline(const Device& device, const GraphicsDesc& desc)
{
    const bool hasFragment = !desc.fragmentShader.empty();
    const bool hasDepth = desc.depthFormat != VK_FORMAT_UNDEFINED;
    Pipeline pipeline = createLayout(device, desc.name, VK_PIPELINE_BIND_POINT_GRAPHICS,
                                     VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT,
                                     desc.pushBytes, desc.bindings, desc.drawBindings);

    const Specialisation constants(desc.constants);
    const UniqueShaderModule vertex = createModule(device, desc.vertexShader);
    UniqueShaderModule fragment;
    std::vector<VkPipelineShaderStageCreateInfo> stages = {
        stageInfo(VK_SHADER_STAGE_VERTEX_BIT, vertex, constants)};
    if (hasFragment) {
        fragment = createModule(device, desc.fragmentShader);
        stages.push_back(stageInfo(VK_SHADER_STAGE_FRAGMENT_BIT, fragment, constants));
    }

    VkPipelineVertexInputStateCreateInfo vertexInput = {
        VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    vertexInput.vertexBindingDescriptionCount =
        static_cast<std::uint32_t>(desc.vertexBindings.size());
    vertexInput.pVertexBindingDescriptions = desc.vertexBindings.data();
    vertexInput.vertexAttributeDescriptionCount =
        static_cast<std::uint32_t>(desc.vertexAttributes.size());
    vertexInput.pVertexAttributeDescriptions = desc.vertexAttributes.data();

    VkPipelineInputAssemblyStateCreateInfo assembly = {
        VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
    assembly.topology = desc.topology;

    VkPipelineViewportStateCreateInfo viewport = {
        VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
    viewport.viewportCount = 1;
    viewport.scissorCount = 1;

    VkPipelineRasterizationStateCreateInfo raster = {
        VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
    raster.cullMode = desc.cull;
    raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
    raster.lineWidth = 1;

    VkPipelineMultisampleStateCreateInfo samples = {
        VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;

    VkPipelineDepthStencilStateCreateInfo depth = {
        VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
    depth.depthTestEnable = hasDepth && desc.depthTest;
    depth.depthWriteEnable = hasDepth && desc.depthWrite;
    depth.depthCompareOp = desc.depthCompare;

    const std::vector<VkPipelineColorBlendAttachmentState> blends(desc.colorFormats.size(),
                                                                  blendState(desc.blend));
    VkPipelineColorBlendStateCreateInfo blend = {
        VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    blend.attachmentCount = static_cast<std::uint32_t>(blends.size());
    blend.pAttachments = blends.data();

    constexpr std::array kDynamic = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic = {
        VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
    dynamic.dynamicStateCount = kDynamic.size();
    dynamic.pDynamicStates = kDynamic.data();

    VkPipelineRenderingCreateInfo rendering = {VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
    rendering.colorAttachmentCount = static_cast<std::uint32_t>(desc.colorFormats.size());
    rendering.pColorAttachmentFormats = desc.colorFormats.data();
    rendering.depthAttachmentFormat = desc.depthFormat;

    VkGraphicsPipelineCreateInfo info = {VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
    info.pNext = &rendering;
    info.stageCount = static_cast<std::uint32_t>(stages.size());
    info.pStages = stages.data();
    info.pVertexInputState = &vertexInput;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &blend;
    info.pDynamicState = &dynamic;
    info.layout = pipeline.layout;
    VkPipeline handle = VK_NULL_HANDLE;
    const VkResult result =
        vkCreateGraphicsPipelines(device.handle, device.pipelineCache, 1, &info, nullptr, &handle);
    return finish(device, std::move(pipeline), result, handle);
}

void bind(VkCommandBuffer cmd, const Pipeline& pipeline, VkDescriptorSet set, const void* push,
          std::size_t pushBytes)
{
    PENUMBRA_ASSERT(pushBytes == pipeline.pushBytes, "'{}' takes {} push bytes, given {}",
                    pipeline.name, pipeline.pushBytes, pushBytes);
    PENUMBRA_ASSERT((set != VK_NULL_HANDLE) == (pipeline.setLayout != VK_NULL_HANDLE),
                    "'{}' takes a descriptor set or not", pipeline.name);
    vkCmdBindPipeline(cmd, pipeline.bindPoint, pipeline.handle);
    if (set != VK_NULL_HANDLE)
        vkCmdBindDescriptorSets(cmd, pipeline.bindPoint, pipeline.layout, 0, 1, &set, 0, nullptr);
    if (pushBytes > 0)
        vkCmdPushConstants(cmd, pipeline.layout, pipeline.pushStages, 0, pipeline.pushBytes, push);
}

void bindDrawSet(VkCommandBuffer cmd, const Pipeline& pipeline, VkDescriptorSet set)
{
    PENUMBRA_ASSERT(pipeline.drawSetLayout, "'{}' has no set 1", pipeline.name);
    vkCmdBindDescriptorSets(cmd, pipeline.bindPoint, pipeline.layout, 1, 1, &set, 0, nullptr);
}

void setViewport(VkCommandBuffer cmd, VkExtent2D extent)
{
    const auto width = static_cast<float>(extent.width);
    const auto height = static_cast<float>(extent.height);
    const VkViewport viewport = {0, height, width, -height, 0, 1};
    const VkRect2D scissor = {{0, 0}, extent};
    vkCmdSetViewport(cmd, 0, 1, &viewport);
    vkCmdSetScissor(cmd, 0, 1, &scissor);
}

} // namespace penumbra
