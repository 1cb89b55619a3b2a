#include "demo/window.h"

#include "demo/controls.h"
#include "demo/editor/editor.h"
#include "demo/editor/overlay.h"
#include "demo/renderer.h"
#include "demo/save_panel.h"
#include "demo/simulation.h"
#include "runtime/vk/barriers.h"
#include "runtime/vk/instance.h"
#include "runtime/vk/swapchain.h"

#include <chrono>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

namespace penumbra {

namespace {

struct Glfw {
    bool ready = false;
    GLFWwindow* window = nullptr;
    ~Glfw()
    {
        if (window)
            glfwDestroyWindow(window);
        if (ready)
            glfwTerminate();
    }
};

struct Surface {
    VkInstance instance = VK_NULL_HANDLE;
    VkSurfaceKHR handle = VK_NULL_HANDLE;
    ~Surface()
    {
        if (handle)
            vkDestroySurfaceKHR(instance, handle, nullptr);
    }
};

VkExtent2D framebufferExtent(GLFWwindow* window)
{
    int width = 0, height = 0;
    glfwGetFramebufferSize(window, &width, &height);
    return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
}

Result<GLFWwindow*> openWindow(Glfw& glfw, const DemoOptions& options)
{
    if (!glfwInit()) {
        const char* reason = nullptr;
        glfwGetError(&reason);
        return Error{fmt::format("no display ({}); add --headless to render to files",
                                 reason ? reason : "GLFW gives no reason")};
    }
    glfw.ready = true;
    if (!glfwVulkanSupported())
        return Error{"no Vulkan driver; install mesa-vulkan-drivers or the driver of your GPU"};
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfw.window = glfwCreateWindow(static_cast<int>(options.width),
                                   static_cast<int>(options.height), "Penumbra", nullptr, nullptr);
    if (!glfw.window)
        return Error{"the display refuses a window; add --headless to render to files"};
    return glfw.window;
}

void copyToWindow(VkCommandBuffer cmd, const Image& display, const Swapchain& swapchain)
{
    transitionImage(cmd, swapchain.image(), VK_IMAGE_ASPECT_COLOR_BIT, kUndefinedImage,
                    kCopyTarget);
    const auto corner = [](VkExtent2D e) {
        return VkOffset3D{static_cast<int>(e.width), static_cast<int>(e.height), 1};
    };
    const VkImageSubresourceLayers layers{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    const VkImageBlit blit{
        layers, {{}, corner(display.extent)}, layers, {{}, corner(swapchain.extent())}};
    vkCmdBlitImage(cmd, display.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, swapchain.image(),
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit, VK_FILTER_NEAREST);
    transitionImage(cmd, swapchain.image(), VK_IMAGE_ASPECT_COLOR_BIT, kCopyTarget, kPresent);
}

// A scene and all that is made for it; made anew at every restart.
struct Show {
    std::unique_ptr<DemoScene> scene;
    std::unique_ptr<Renderer> renderer;
    std::unique_ptr<Simulation> simulation;
};

Result<Show> makeShow(const Device& device, const DemoOptions& options, VkExtent2D extent)
{
    Show show;
    Result<std::unique_ptr<DemoScene>> scene = openScene(options);
    if (!scene)
        return scene.error();
    show.scene = std::move(*scene);
    Result<std::unique_ptr<Renderer>> renderer =
        Renderer::create(device, *show.scene, extent, options.beams);
    if (!renderer)
        return renderer.error();
    show.renderer = std::move(*renderer);
    show.simulation = std::make_unique<Simulation>(*show.scene);
    return show;
}

void drawPanel(Editor& editor, SavePanel& save, Controls& controls, Show& show,
               const std::filesystem::path& assets)
{
    ImGui::SetNextWindowPos({12, 12}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize({380, 560}, ImGuiCond_FirstUseEver);
    if (ImGui::Begin("Scene")) {
        ImGui::Checkbox("pause", &controls.paused);
        ImGui::SameLine();
        controls.restart |= ImGui::Button("restart");
        ImGui::SameLine();
        bool literal = controls.kernel == Kernel::Literal;
        if (ImGui::Checkbox("kernel literal", &literal))
            controls.kernel = literal ? Kernel::Literal : Kernel::Exact;
        save.draw(*show.scene, controls.camera, assets);
        ImGui::Separator();
        editor.draw(show.scene->world, show.scene->assets);
    }
    ImGui::End();
}

// Frames per second in the title, twice a second.
class TitleClock {
public:
    void frame(GLFWwindow* window, const std::string& scene, const Controls& controls)
    {
        ++m_frames;
        const double seconds = std::chrono::duration<double>(Clock::now() - m_start).count();
        if (seconds < 0.5)
            return;
        glfwSetWindowTitle(window,
                           fmt::format("Penumbra - {} - {} - {} - {:.0f} fps", scene,
                                       kernelName(controls.kernel),
                                       receiverKindName(controls.receivers), m_frames / seconds)
                               .c_str());
        m_frames = 0;
        m_start = Clock::now();
    }

private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point m_start = Clock::now();
    int m_frames = 0;
};

} // namespace

Result<void> runWindow(const DemoOptions& options)
{
    Glfw glfw;
    Result<GLFWwindow*> opened = openWindow(glfw, options);
    if (!opened)
        return opened.error();
    GLFWwindow* window = *opened;

    std::uint32_t extensionCount = 0;
    const char** extensions = glfwGetRequiredInstanceExtensions(&extensionCount);
    Result<Instance> instance =
        createInstance({.applicationName = "penumbra-demo",
                        .extensions = {extensions, extensions + extensionCount},
                        .validation = options.validate});
    if (!instance)
        return instance.error();
    Surface surface{instance->handle};
    if (glfwCreateWindowSurface(instance->handle, window, nullptr, &surface.handle) != VK_SUCCESS)
        return Error{"Vulkan cannot draw to this display; add --headless to render to files"};
    Result<Device> device =
        createDevice(*instance, {.choice = options.device, .surface = surface.handle});
    if (!device)
        return device.error();
    Result<Show> show = makeShow(*device, options, framebufferExtent(window));
    if (!show)
        return show.error();
    Result<Swapchain> swapchain = Swapchain::create(*device, surface.handle);
    if (!swapchain)
        return swapchain.error();

    Controls controls{.camera = show->scene->camera,
                      .ground = show->scene->ground(),
                      .kernel = options.kernel,
                      .receivers = options.receivers};
    listenTo(window, controls);
    Result<std::unique_ptr<Overlay>> overlay = Overlay::create(
        *device, window, show->renderer->display().format, show->renderer->ring().framesInFlight());
    if (!overlay)
        return overlay.error();
    Editor editor;
    SavePanel save;
    fmt::print("{}", kKeysText);

    TitleClock title;
    auto last = std::chrono::steady_clock::now();
    std::uint32_t frames = 0;
    while (!glfwWindowShouldClose(window) && (options.frames == 0 || frames < options.frames)) {
        glfwPollEvents();
        const VkExtent2D extent = framebufferExtent(window);
        if (extent.width == 0 || extent.height == 0) { // minimised
            glfwWaitEventsTimeout(0.1);
            continue;
        }
        if (controls.restart) {
            controls.restart = false;
            editor.select({});
            *show = Show{}; // its frames end before the next begin
            Result<Show> again = makeShow(*device, options, extent);
            if (!again)
                return again.error();
            *show = std::move(*again);
        }
        Renderer& renderer = *show->renderer;
        if (extent.width != renderer.extent().width || extent.height != renderer.extent().height)
            if (Result<void> sized = renderer.resize(extent); !sized)
                return sized;
        if (renderer.receivers() != controls.receivers)
            if (Result<void> set = renderer.setReceivers(controls.receivers); !set)
                return set;

        const auto now = std::chrono::steady_clock::now();
        const float seconds = std::chrono::duration<float>(now - last).count();
        last = now;
        (*overlay)->begin();
        if (controls.panel)
            drawPanel(editor, save, controls, *show, options.assets);
        if (Result<void> done = controlSky(window, controls, *show->scene, options.assets, seconds);
            !done)
            return done;
        const float aspect = static_cast<float>(extent.width) / static_cast<float>(extent.height);
        const View view = viewOf(controls.camera, aspect);
        paint(*show->scene, view, cursorClip(window, controls),
              std::exchange(controls.paint, PaintKeys{}));
        // Paused, the scene still follows what is edited.
        if (Result<void> applied =
                renderer.apply(show->simulation->advance(controls.paused ? 0 : seconds));
            !applied)
            return applied;
        Result<GpuFrame> frame = renderer.beginFrame(view, controls.kernel);
        if (!frame)
            return frame.error();
        Result<bool> visible = swapchain->acquire(frame->slot, extent);
        if (!visible)
            return visible.error();
        (*overlay)->record(frame->cmd, renderer.display(), renderer.ring());
        if (*visible)
            copyToWindow(frame->cmd, renderer.display(), *swapchain);
        if (Result<void> ended = renderer.endFrame(swapchain->waits(), swapchain->signals());
            !ended)
            return ended;
        if (Result<void> shown = swapchain->present(); !shown)
            return shown;
        title.frame(window, show->scene->name, controls);
        ++frames;
    }
    if (Result<void> idle = show->renderer->ring().waitIdle(); !idle)
        return idle;
    if (instance->validationCount() > 0)
        return Error{fmt::format("{} validation messages, see above", instance->validationCount())};
    return {};
}

} // namespace penumbra
