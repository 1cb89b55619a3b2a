// Images of a window, from a surface that the caller made with its window library.
//   Result<GpuFrame> frame = ring.beginFrame();
//   Result<bool> visible = swapchain.acquire(frame->slot, windowSize);   // recreates when needed
//   if (*visible) { … transitionImage(cmd, swapchain.image(), …, kPresent) … }
//   ring.endFrame(swapchain.waits(), swapchain.signals());
//   swapchain.present();
#pragma once

#include "runtime/vk/device.h"

namespace penumbra {

struct SwapchainOptions {
    bool vsync = true;                // FIFO; else MAILBOX, IMMEDIATE, FIFO: the first there is
    std::uint32_t framesInFlight = 2; // as the ring's
    std::vector<VkFormat> formats = {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM}; // by wish
};

// Move-only. The surface outlives it; the device was made with that surface.
class Swapchain {
public:
    // Error: the surface is lost, or offers nothing usable.
    static Result<Swapchain> create(const Device& device, VkSurfaceKHR surface,
                                    const SwapchainOptions& options = {});
    Swapchain(Swapchain&&) noexcept;
    Swapchain& operator=(Swapchain&&) = delete;
    ~Swapchain();

    // The next image. `size` is the window's in pixels; when it changed or the images are out of
    // date, waits for the device and makes new ones. False: nothing to draw to (the window is
    // minimised, or it changed again): waits(), signals() and present() then do nothing.
    Result<bool> acquire(std::uint32_t slot, VkExtent2D size);
    Result<void> present();

    void setVsync(bool vsync); // from the next acquire on

    [[nodiscard]] VkImage image() const;         // acquired; contents and layout undefined
    [[nodiscard]] VkImageView imageView() const; // for dynamic rendering; copies may write it too
    [[nodiscard]] VkExtent2D extent() const;
    [[nodiscard]] VkFormat format() const;
    [[nodiscard]] std::uint32_t imageCount() const; // 0 before the first acquire

    [[nodiscard]] std::span<const VkSemaphoreSubmitInfo> waits() const;
    [[nodiscard]] std::span<const VkSemaphoreSubmitInfo> signals() const;

private:
    struct State;
    explicit Swapchain(std::unique_ptr<State> state);
    std::unique_ptr<State> m_state;
};

} // namespace penumbra
