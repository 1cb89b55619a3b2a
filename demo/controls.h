// What the mouse and the keyboard change while a scene is shown.
#pragma once

#include "demo/paint.h"
#include "demo/scene.h"
#include "systems/receiver_kind.h"
#include "systems/techniques/shadow_fields/kernel.h"

struct GLFWwindow;

namespace penumbra {

struct Controls {
    Camera camera;
    double cursorX = 0, cursorY = 0;
    bool ground = false; // the camera stays above it
    bool paused = false, restart = false, panel = true, nextSky = false;
    PaintKeys paint;
    Kernel kernel = Kernel::Exact;
    ReceiverKind receivers = ReceiverKind::Vertex;
};

// Printed when the window opens.
inline constexpr const char* kKeysText =
    "left drag: orbit, right drag: pan, wheel: zoom, space: pause, R: restart, K: kernel, P: "
    "receivers\n"
    "left/right: turn the sky, page up/down: its brightness, E: next sky\n"
    "G: gloss of the object under the cursor, up/down: its exponent\n"
    "Tab: editor, Esc: quit\n";

// The window's input goes to `controls` from now on, but for what is meant for a panel.
void listenTo(GLFWwindow* window, Controls& controls);

// The cursor in clip space, +Y up.
vec2 cursorClip(GLFWwindow* window, const Controls& controls);

// Keys that are held down turn the sky and make it brighter or darker. Error: the next sky cannot
// be read.
Result<void> controlSky(GLFWwindow* window, Controls& c, DemoScene& scene,
                        const std::filesystem::path& assets, float seconds);

} // namespace penumbra
