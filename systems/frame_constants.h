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

// Radiance in SH of order 6, times an intensity. Kernel literal takes the first 16, the papers'
// order 4; kernel exact all, at its nodes.
using LightSh = std::array<vec3, kLightCoefficients>;
LightSh environmentLight(const Environment& environment, float intensity);

// The environment above solid, dark ground at y = 0: map and SH without the directions below the
// horizon. The product of the ground's occlusion and the light is so computed once, exactly, for
// all receivers above the plane. `up`: the unit direction of the map that is the world's +y, so a
// map that is rotated is cut first and rotated then; +y for all turns about y. A pixel that the
// horizon crosses keeps the part above it. Takes some 20 ms for the largest map.
Environment aboveGround(const Environment& environment, vec3 up = vec3(0, 1, 0));

// Light that comes from d comes from `rotation` d afterwards.
LightSh rotatedLight(const LightSh& light, const mat3& rotation);

// All tests of kCullAll are on. `backgroundIntensity`: factor of what is drawn behind the scene
// (GpuScene::setBackground).
FrameConstants frameConstants(const View& view, const LightSh& light,
                              float backgroundIntensity = 1);

// Light of the frame at the nodes kShNodes, which lie in the axes of an object, times their
// weights: what pass instance_update writes per instance.
using SkyNodes = std::array<vec3, kSkyNodes>;
SkyNodes skyNodes(const FrameConstants& frame, const mat3& worldFromObject);

} // namespace penumbra
