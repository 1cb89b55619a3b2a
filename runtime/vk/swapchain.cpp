#include "runtime/vk/swapchain.h"

#include <algorithm>

namespace penumbra {

struct Swapchain::State {
    VkDevice device = VK_NULL_HANDLE;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    std::mutex* queueMutex = nullptr;
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    SwapchainOptions options;
    VkSurfaceFormatKHR format = {};

    VkSwapchainKHR handle = VK_NULL_HANDLE;
    VkExtent2D extent = {};
    VkExtent2D askedSize = {};
    bool stale = true; // make new images before the next acquire
    std::vector<VkImage> images;
    std::vector<UniqueImageView> views; // [images]
    std::vector<UniqueSemaphore>
        rendered; // [images], signalled by the frame, waited for by present
    std::vector<UniqueSemaphore> available; // [framesInFlight], signalled by acquire

    bool acquired = false;
    std::uint32_t index = 0; // of the acquired image
    VkSemaphoreSubmitInfo waitInfo = {VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO};
    VkSemaphoreSubmitInfo signalInfo = {VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO};

    ~State()
    {
        waitIdle();
        views.clear();
        vkDestroySwapchainKHR(device, handle, nullptr);
    }

    void waitIdle()
    {
        const std::lock_guard lock(*queueMutex);
        vkDeviceWaitIdle(device); // a lost device shows at the next submit
    }

    Result<void> recreate(VkExtent2D size);
    Result<VkPresentModeKHR> presentMode() const;
};

namespace {

UniqueSemaphore createSemaphore(VkDevice device)
{
    const VkSemaphoreCreateInfo info = {VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    VkSemaphore semaphore = VK_NULL_HANDLE;
    vkCheck(vkCreateSemaphore(device, &info, nullptr, &semaphore), "create a semaphore");
    return {device, semaphore};
}

UniqueImageView createView(VkDevice device, VkImage image, VkFormat format)
{
    VkImageViewCreateInfo info = {VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    info.image = image;
    info.viewType = VK_IMAGE_VIEW_TYPE_2D;
    info.format = format;
    info.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    VkImageView view = VK_NULL_HANDLE;
    vkCheck(vkCreateImageView(device, &info, nullptr, &view),
            "create a view of the window's image");
    return {device, view};
}

VkExtent2D fitExtent(const VkSurfaceCapabilitiesKHR& surface, VkExtent2D size)
{
    if (surface.currentExtent.width != UINT32_MAX) // the window system decides
        return surface.currentExtent;
    return {std::clamp(size.width, surface.minImageExtent.width, surface.maxImageExtent.width),
            std::clamp(size.height, surface.minImageExtent.height, surface.maxImageExtent.height)};
}

} // namespace

Result<VkPresentModeKHR> Swapchain::State::presentMode() const
{
    if (options.vsync)
        return VK_PRESENT_MODE_FIFO_KHR; // always there
    std::uint32_t count = 0;
    if (Result<void> ok =
            vkTry(vkGetPhysicalDeviceSurfacePresentModesKHR(physical, surface, &count, nullptr),
                  "count present modes");
        !ok)
        return ok.error();
    std::vector<VkPresentModeKHR> modes(count);
    if (Result<void> ok = vkTry(
            vkGetPhysicalDeviceSurfacePresentModesKHR(physical, surface, &count, modes.data()),
            "list present modes");
        !ok)
        return ok.error();
    for (const VkPresentModeKHR mode : {VK_PRESENT_MODE_MAILBOX_KHR, VK_PRESENT_MODE_IMMEDIATE_KHR})
        if (std::find(modes.begin(), modes.end(), mode) != modes.end())
            return mode;
    return VK_PRESENT_MODE_FIFO_KHR;
}

Result<void> Swapchain::State::recreate(VkExtent2D size)
{
    waitIdle();
    askedSize = size;
    VkSurfaceCapabilitiesKHR capabilities;
    if (Result<void> ok =
            vkTry(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(physical, surface, &capabilities),
                  "ask the window for its capabilities");
        !ok)
        return ok;
    extent = fitExtent(capabilities, size);
    if (extent.width == 0 || extent.height == 0)
        return {}; // minimised; still stale
    const Result<VkPresentModeKHR> mode = presentMode();
    if (!mode)
        return mode.error();

    VkSwapchainCreateInfoKHR info = {VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
    info.surface = surface;
    info.minImageCount = capabilities.minImageCount + 1; // one to draw into while the rest is shown
    if (capabilities.maxImageCount > 0)
        info.minImageCount = std::min(info.minImageCount, capabilities.maxImageCount);
    info.imageFormat = format.format;
    info.imageColorSpace = format.colorSpace;
    info.imageExtent = extent;
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                      (capabilities.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    info.preTransform = capabilities.currentTransform;
    info.compositeAlpha = capabilities.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                              ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                              : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
    info.presentMode = *mode;
    info.clipped = VK_TRUE;
    info.oldSwapchain = handle;
    VkSwapchainKHR created = VK_NULL_HANDLE;
    Result<void> ok =
        vkTry(vkCreateSwapchainKHR(device, &info, nullptr, &created), "create a swapchain");
    views.clear();
    rendered.clear();
    images.clear();
    vkDestroySwapchainKHR(device, std::exchange(handle, created), nullptr);
    if (!ok)
        return ok;

    std::uint32_t count = 0;
    vkCheck(vkGetSwapchainImagesKHR(device, handle, &count, nullptr), "count swapchain images");
    images.resize(count);
    vkCheck(vkGetSwapchainImagesKHR(device, handle, &count, images.data()),
            "list swapchain images");
    for (const VkImage image : images) {
        views.push_back(createView(device, image, format.format));
        rendered.push_back(createSemaphore(device));
    }
    stale = false;
    return {};
}

Result<Swapchain> Swapchain::create(const Device& device, VkSurfaceKHR surface,
                                    const SwapchainOptions& options)
{
    auto state = std::make_unique<State>();
    state->device = device.handle;
    state->physical = device.physical;
    state->queue = device.queue;
    state->queueMutex = device.queueMutex.get();
    state->surface = surface;
    state->options = options;

    std::uint32_t count = 0;
    if (Result<void> ok =
            vkTry(vkGetPhysicalDeviceSurfaceFormatsKHR(device.physical, surface, &count, nullptr),
                  "count the window's formats");
        !ok)
        return ok.error();
    std::vector<VkSurfaceFormatKHR> formats(count);
    if (Result<void> ok = vkTry(
            vkGetPhysicalDeviceSurfaceFormatsKHR(device.physical, surface, &count, formats.data()),
            "list the window's formats");
        !ok)
        return ok.error();
    if (formats.empty())
        return Error{"the window offers no image format; use another device, or run headless"};
    state->format = formats.front();
    const auto wanted = [&](const VkSurfaceFormatKHR& f) {
        const auto wish = std::find(options.formats.begin(), options.formats.end(), f.format);
        return f.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR ? wish : options.formats.end();
    };
    for (const VkSurfaceFormatKHR& f : formats)
        if (wanted(f) < wanted(state->format))
            state->format = f;

    for (std::uint32_t i = 0; i < options.framesInFlight; ++i)
        state->available.push_back(createSemaphore(device.handle));
    return Swapchain(std::move(state));
}

Swapchain::Swapchain(std::unique_ptr<State> state) : m_state(std::move(state)) {}
Swapchain::Swapchain(Swapchain&&) noexcept = default;
Swapchain::~Swapchain() = default;

Result<bool> Swapchain::acquire(std::uint32_t slot, VkExtent2D size)
{
    State& s = *m_state;
    PENUMBRA_ASSERT(!s.acquired, "present() comes before the next acquire()");
    PENUMBRA_ASSERT(slot < s.available.size(), "slot {} of {}", slot, s.available.size());
    if (size.width == 0 || size.height == 0)
        return false;
    for (int attempt = 0; attempt < 2; ++attempt) {
        if (s.stale || size.width != s.askedSize.width || size.height != s.askedSize.height) {
            if (Result<void> ok = s.recreate(size); !ok)
                return ok.error();
            if (s.stale)
                return false;
        }
        const VkResult result = vkAcquireNextImageKHR(s.device, s.handle, UINT64_MAX,
                                                      s.available[slot], VK_NULL_HANDLE, &s.index);
        s.stale = result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR;
        if (result == VK_ERROR_OUT_OF_DATE_KHR)
            continue;
        if (result != VK_SUBOPTIMAL_KHR) // which still is an image
            if (Result<void> ok = vkTry(result, "get an image of the window"); !ok)
                return ok.error();
        s.acquired = true;
        s.waitInfo.semaphore = s.available[slot];
        s.waitInfo.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        s.signalInfo.semaphore = s.rendered[s.index];
        s.signalInfo.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        return true;
    }
    return false;
}

Result<void> Swapchain::present()
{
    State& s = *m_state;
    if (!std::exchange(s.acquired, false))
        return {};
    const VkSemaphore wait = s.rendered[s.index];
    VkPresentInfoKHR info = {VK_STRUCTURE_TYPE_PRESENT_INFO_KHR};
    info.waitSemaphoreCount = 1;
    info.pWaitSemaphores = &wait;
    info.swapchainCount = 1;
    info.pSwapchains = &s.handle;
    info.pImageIndices = &s.index;
    const std::lock_guard lock(*s.queueMutex);
    const VkResult result = vkQueuePresentKHR(s.queue, &info);
    if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR) {
        s.stale = true;
        return {};
    }
    return vkTry(result, "show the frame");
}

void Swapchain::setVsync(bool vsync)
{
    m_state->stale |= vsync != std::exchange(m_state->options.vsync, vsync);
}

VkImage Swapchain::image() const
{
    return m_state->images.at(m_state->index);
}
VkImageView Swapchain::imageView() const
{
    return m_state->views.at(m_state->index);
}
VkExtent2D Swapchain::extent() const
{
    return m_state->extent;
}
VkFormat Swapchain::format() const
{
    return m_state->format.format;
}
std::uint32_t Swapchain::imageCount() const
{
    return static_cast<std::uint32_t>(m_state->images.size());
}

std::span<const VkSemaphoreSubmitInfo> Swapchain::waits() const
{
    return {&m_state->waitInfo, m_state->acquired ? 1u : 0u};
}

std::span<const VkSemaphoreSubmitInfo> Swapchain::signals() const
{
    return {&m_state->signalInfo, m_state->acquired ? 1u : 0u};
}

} // namespace penumbra
