#include "demo/controls.h"

#include "demo/editor/overlay.h"
#include "demo/sky_control.h"

#include <algorithm>
#include <cmath>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace penumbra {

namespace {

constexpr float kRadiansPerPixel = 0.006f;

void onCursor(GLFWwindow* window, double x, double y)
{
    auto& c = *static_cast<Controls*>(glfwGetWindowUserPointer(window));
    const auto dx = static_cast<float>(x - c.cursorX), dy = static_cast<float>(y - c.cursorY);
    c.cursorX = x;
    c.cursorY = y;
    if (Overlay::wantsMouse())
        return;
    Camera& camera = c.camera;
    if (glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS) {
        camera.yaw -= dx * kRadiansPerPixel;
        camera.pitch =
            std::clamp(camera.pitch + dy * kRadiansPerPixel, c.ground ? 0.02f : -1.5f, 1.5f);
    } else if (glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS) {
        const float metresPerPixel = camera.distance * 0.001f;
        camera.target +=
            metresPerPixel *
            (-dx * vec3(std::cos(camera.yaw), 0, -std::sin(camera.yaw)) + dy * vec3(0, 1, 0));
        if (c.ground)
            camera.target.y = std::max(camera.target.y, 0.0f);
    }
}

void onScroll(GLFWwindow* window, double, double steps)
{
    auto& c = *static_cast<Controls*>(glfwGetWindowUserPointer(window));
    if (Overlay::wantsMouse())
        return;
    c.camera.distance = std::clamp(c.camera.distance * std::pow(0.9f, static_cast<float>(steps)),
                                   16 * c.camera.near, 0.3f * c.camera.far);
}

void onKey(GLFWwindow* window, int key, int, int action, int)
{
    auto& c = *static_cast<Controls*>(glfwGetWindowUserPointer(window));
    if (action != GLFW_PRESS || Overlay::wantsKeyboard())
        return;
    if (key == GLFW_KEY_ESCAPE)
        glfwSetWindowShouldClose(window, GLFW_TRUE);
    else if (key == GLFW_KEY_SPACE)
        c.paused = !c.paused;
    else if (key == GLFW_KEY_R)
        c.restart = true;
    else if (key == GLFW_KEY_E)
        c.nextSky = true;
    else if (key == GLFW_KEY_K)
        c.kernel = c.kernel == Kernel::Exact ? Kernel::Literal : Kernel::Exact;
    else if (key == GLFW_KEY_TAB)
        c.panel = !c.panel;
    else if (key == GLFW_KEY_G)
        c.paint.toggle = !c.paint.toggle;
    else if (key == GLFW_KEY_UP || key == GLFW_KEY_DOWN)
        c.paint.factor *= key == GLFW_KEY_UP ? 2.0f : 0.5f;
    else if (key == GLFW_KEY_P)
        c.receivers = static_cast<ReceiverKind>((static_cast<int>(c.receivers) + 1) % 3);
}

} // namespace

void listenTo(GLFWwindow* window, Controls& controls)
{
    glfwSetWindowUserPointer(window, &controls);
    glfwSetCursorPosCallback(window, onCursor);
    glfwSetScrollCallback(window, onScroll);
    glfwSetKeyCallback(window, onKey);
}

vec2 cursorClip(GLFWwindow* window, const Controls& controls)
{
    int width = 0, height = 0;
    glfwGetWindowSize(window, &width, &height);
    return {2 * static_cast<float>(controls.cursorX) / static_cast<float>(std::max(width, 1)) - 1,
            1 - 2 * static_cast<float>(controls.cursorY) / static_cast<float>(std::max(height, 1))};
}

Result<void> controlSky(GLFWwindow* window, Controls& c, DemoScene& scene,
                        const std::filesystem::path& assets, float seconds)
{
    constexpr float kRadiansPerSecond = 0.8f, kStopsPerSecond = 1.5f, kFadeSeconds = 2;
    const auto direction = [&](int more, int less) {
        const auto held = [&](int key) { return glfwGetKey(window, key) == GLFW_PRESS ? 1 : 0; };
        return Overlay::wantsKeyboard() ? 0 : static_cast<float>(held(more) - held(less)) * seconds;
    };
    if (const float turn = direction(GLFW_KEY_RIGHT, GLFW_KEY_LEFT); turn != 0)
        turnSky(scene.world, turn * kRadiansPerSecond);
    if (const float brighter = direction(GLFW_KEY_PAGE_UP, GLFW_KEY_PAGE_DOWN); brighter != 0)
        scaleSky(scene.world, std::exp2(brighter * kStopsPerSecond));
    if (std::exchange(c.nextSky, false))
        return fadeToNextSky(scene, assets, kFadeSeconds);
    return {};
}

} // namespace penumbra
