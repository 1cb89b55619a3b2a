// From a camera and an environment to the constants of a frame (shaders/shared/instance.h).
#pragma once

#include "assets/environment.h"
#include "shaders/shared/instance.h"
#include "systems/components.h"

namespace penumbra {

struct View {
    mat4 clipFromWorld{1}; // Vulkan clip space, depth 0..1, +Y up (the viewport flips it)
    vec3 eye{0};           // world, metres
};

View viewOf(const Camera& camera, float aspect);

// Light that reaches the scene, in SH of order 4. With `ground`, the half-space y < 0 is solid and dark: directions
// below the horizon are blocked for every receiver, exactly, by clipping the map before the projection. The product of
// the plane's occlusion and the light is so precomputed once, for any number of receivers above the plane.
using LightSh = std::array<vec3, 16>;
LightSh environmentLight(const Environment& environment, float intensity, bool ground);

FrameConstants frameConstants(const View& view, const LightSh& light, float backgroundIntensity);

} // namespace penumbra
