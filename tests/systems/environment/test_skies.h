// Maps and lights that the tests of environments share.
#pragma once

#include "assets/environment.h"
#include "shaders/shared/environment.h"
#include "systems/components.h"
#include "systems/rotation.h"

namespace penumbra {

// The map of radianceOf(unit direction).
template <class F>
Environment makeSky(std::uint32_t width, std::uint32_t height, F&& radianceOf)
{
    std::vector<vec3> map;
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            map.push_back(radianceOf(
                equirectDirection((vec2(x, y) + 0.5f) /
                                  vec2(static_cast<float>(width), static_cast<float>(height)))));
    return makeEnvironment(width, height, std::move(map));
}

inline vec3 lobe(vec3 direction, vec3 axis, float sharpness, vec3 radiance)
{
    return radiance * std::exp(sharpness * (dot(direction, normalize(axis)) - 1));
}

// Lopsided in all three axes; smooth over a pixel of 1.4 degrees.
inline vec3 lopsided(vec3 d)
{
    return vec3(0.2f, 0.3f, 0.4f) + lobe(d, vec3(1, 2, 0.5f), 6, vec3(3, 2, 1)) +
           lobe(d, vec3(-1, 0.3f, 2), 3, vec3(0.2f, 1, 2)) +
           lobe(d, vec3(0.4f, -1, -2), 5, vec3(1, 0.3f, 0.6f));
}

inline vec3 evening(vec3 d)
{
    return vec3(0.1f, 0.1f, 0.2f) + lobe(d, vec3(-2, 0.4f, -1), 12, vec3(9, 5, 2));
}

inline vec4 turnAbout(vec3 axis, float radians)
{
    return toVec4(glm::angleAxis(radians, normalize(axis)));
}

inline vec4 yaw(float radians)
{
    return turnAbout(vec3(0, 1, 0), radians);
}

} // namespace penumbra
