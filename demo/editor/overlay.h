// Dear ImGui on a window, drawn over a finished frame.
//   overlay->begin();  … ImGui calls …  overlay->record(frame->cmd, renderer.display(), ring);
#pragma once

#include "runtime/vk/frame_ring.h"
#include "runtime/vk/image.h"

#include <memory>

struct GLFWwindow;

namespace penumbra {

// One at a time. Made after the window's own input callbacks are set: it calls them first.
class Overlay {
public:
    // `format` of the images that record() draws on. Error: out of memory, device lost.
    static Result<std::unique_ptr<Overlay>> create(const Device& device, GLFWwindow* window,
                                                   VkFormat format, std::uint32_t framesInFlight);
    Overlay(const Overlay&) = delete;
    Overlay& operator=(const Overlay&) = delete;
    ~Overlay();

    void begin();
    // Ends the ImGui frame and draws it. The image is a copy source before and after; `ring` owns
    // the frame that `cmd` records.
    void record(VkCommandBuffer cmd, const Image& target, FrameRing& ring);

    // The pointer is on a panel, or a text field has the keyboard: not for the scene.
    [[nodiscard]] static bool wantsMouse();
    [[nodiscard]] static bool wantsKeyboard();

private:
    explicit Overlay(const Device& device) : m_device(device) {}

    const Device& m_device;
    UniqueDescriptorPool m_pool;
    Owned<VkRenderPass, vkDestroyRenderPass> m_pass; // the library's backend knows no other way
    bool m_glfwReady = false, m_vulkanReady = false;
};

} // namespace penumbra
