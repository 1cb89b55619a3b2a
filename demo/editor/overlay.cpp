#include "demo/editor/overlay.h"

#include "runtime/vk/barriers.h"
#include "runtime/vk/check.h"
#include "runtime/vk/transfer.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

namespace penumbra {

namespace {

using UniqueFramebuffer = Owned<VkFramebuffer, vkDestroyFramebuffer>;

// Draws over what is there; the layout stays that of a colour target.
VkResult createPass(VkDevice device, VkFormat format, VkRenderPass* pass)
{
    const VkAttachmentDescription attachment{
        .format = format,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .loadOp = VK_ATTACHMENT_LOAD_OP_LOAD,
        .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
        .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
        .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
        .initialLayout = kColorTarget.layout,
        .finalLayout = kColorTarget.layout,
    };
    const VkAttachmentReference reference{0, kColorTarget.layout};
    const VkSubpassDescription subpass{.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                       .colorAttachmentCount = 1,
                                       .pColorAttachments = &reference};
    const VkRenderPassCreateInfo info{.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                      .attachmentCount = 1,
                                      .pAttachments = &attachment,
                                      .subpassCount = 1,
                                      .pSubpasses = &subpass};
    return vkCreateRenderPass(device, &info, nullptr, pass);
}

} // namespace

Result<std::unique_ptr<Overlay>> Overlay::create(const Device& device, GLFWwindow* window,
                                                 VkFormat format, std::uint32_t framesInFlight)
{
    std::unique_ptr<Overlay> overlay(new Overlay(device));
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1}; // the font
    const VkDescriptorPoolCreateInfo poolInfo{
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
        .flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT,
        .maxSets = 1,
        .poolSizeCount = 1,
        .pPoolSizes = &size};
    VkDescriptorPool pool = VK_NULL_HANDLE;
    if (Result<void> made = vkTry(vkCreateDescriptorPool(device.handle, &poolInfo, nullptr, &pool),
                                  "create the panel's descriptor pool");
        !made)
        return made.error();
    overlay->m_pool = UniqueDescriptorPool(device.handle, pool);
    VkRenderPass pass = VK_NULL_HANDLE;
    if (Result<void> made =
            vkTry(createPass(device.handle, format, &pass), "create the panel's render pass");
        !made)
        return made.error();
    overlay->m_pass = {device.handle, pass};

    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr; // no file beside the program
    overlay->m_glfwReady = ImGui_ImplGlfw_InitForVulkan(window, true);
    ImGui_ImplVulkan_InitInfo info{};
    info.Instance = device.instance;
    info.PhysicalDevice = device.physical;
    info.Device = device.handle;
    info.QueueFamily = device.queueFamily;
    info.Queue = device.queue;
    info.PipelineCache = device.pipelineCache;
    info.DescriptorPool = pool;
    info.MinImageCount = std::max(framesInFlight, 2u); // of vertex buffers, used in turn
    info.ImageCount = info.MinImageCount;
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    info.CheckVkResultFn = [](VkResult result) { vkCheck(result, "draw the panel"); };
    overlay->m_vulkanReady = ImGui_ImplVulkan_Init(&info, pass);
    PENUMBRA_ASSERT(overlay->m_glfwReady && overlay->m_vulkanReady, "ImGui refuses the window");
    Result<void> uploaded = submitAndWait(
        device, [](VkCommandBuffer cmd) { ImGui_ImplVulkan_CreateFontsTexture(cmd); });
    if (!uploaded)
        return uploaded.error();
    ImGui_ImplVulkan_DestroyFontUploadObjects();
    return overlay;
}

Overlay::~Overlay()
{
    vkDeviceWaitIdle(m_device.handle); // after an error its last frame may still run
    if (m_vulkanReady)
        ImGui_ImplVulkan_Shutdown();
    if (m_glfwReady)
        ImGui_ImplGlfw_Shutdown();
    if (ImGui::GetCurrentContext())
        ImGui::DestroyContext();
}

void Overlay::begin()
{
    ImGui_ImplVulkan_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

void Overlay::record(VkCommandBuffer cmd, const Image& target, FrameRing& ring)
{
    ImGui::Render();
    const VkImageView view = target.view;
    const VkFramebufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                       .renderPass = m_pass,
                                       .attachmentCount = 1,
                                       .pAttachments = &view,
                                       .width = target.extent.width,
                                       .height = target.extent.height,
                                       .layers = 1};
    VkFramebuffer framebuffer =
        VK_NULL_HANDLE; // of this frame: nothing to follow when targets change
    vkCheck(vkCreateFramebuffer(m_device.handle, &info, nullptr, &framebuffer),
            "create the panel's framebuffer");
    ring.retire(UniqueFramebuffer(m_device.handle, framebuffer));

    transitionImage(cmd, target.handle, target.aspect, kCopySource, kColorTarget);
    const VkRenderPassBeginInfo begin{.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                      .renderPass = m_pass,
                                      .framebuffer = framebuffer,
                                      .renderArea = {.extent = target.extent}};
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), cmd);
    vkCmdEndRenderPass(cmd);
    transitionImage(cmd, target.handle, target.aspect, kColorTarget, kCopySource);
}

bool Overlay::wantsMouse()
{
    return ImGui::GetCurrentContext() && ImGui::GetIO().WantCaptureMouse;
}

bool Overlay::wantsKeyboard()
{
    return ImGui::GetCurrentContext() && ImGui::GetIO().WantTextInput;
}

} // namespace penumbra
