#include "systems/frame_constants.h"

#include "assets/sh_basis.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

namespace penumbra {

View viewOf(const Camera& camera, float aspect)
{
    const vec3 back(std::cos(camera.pitch) * std::sin(camera.yaw), std::sin(camera.pitch),
                    std::cos(camera.pitch) * std::cos(camera.yaw));
    View view;
    view.eye = camera.target + camera.distance * back;
    view.clipFromWorld =
        glm::perspectiveRH_ZO(camera.fieldOfView, aspect, camera.near, camera.far) *
        glm::lookAtRH(view.eye, camera.target, vec3(0, 1, 0));
    return view;
}

LightSh environmentLight(const Environment& environment, float intensity)
{
    LightSh light = environment.sh6;
    for (vec3& coefficient : light)
        coefficient *= intensity;
    return light;
}

Environment aboveGround(const Environment& environment)
{
    std::vector<vec3> map = environment.map;
    const std::size_t firstBelow =
        (environment.mapHeight + 1) / 2; // row whose centre looks below the horizon
    std::fill(map.begin() + static_cast<std::ptrdiff_t>(firstBelow * environment.mapWidth),
              map.end(), vec3(0));
    Environment clipped =
        makeEnvironment(environment.mapWidth, environment.mapHeight, std::move(map));
    clipped.statistics = environment.statistics;
    return clipped;
}

FrameConstants frameConstants(const View& view, const LightSh& light, float backgroundIntensity)
{
    FrameConstants frame{};
    frame.clipFromWorld = view.clipFromWorld;
    frame.worldFromClip = glm::inverse(view.clipFromWorld);
    frame.eye = vec4(view.eye, 1);
    frame.backgroundIntensity = backgroundIntensity;

    // Planes from the rows of the matrix (Gribb and Hartmann 2001), normalised so that distances
    // are metres.
    const mat4 rows = glm::transpose(view.clipFromWorld);
    const vec4 planes[6] = {rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1],
                            rows[3] - rows[1], rows[2],           rows[3] - rows[2]};
    for (int i = 0; i < 6; ++i)
        frame.frustum[i] = planes[i] / length(vec3(planes[i]));

    for (int k = 0; k < 16; ++k)
        frame.light[k] = vec4(light[static_cast<std::size_t>(k)], 0);
    for (int n = 0; n < 32; ++n) {
        std::array<double, 36> basis{};
        shBasisAnyOrder(6, glm::dvec3(kShNodes[n]), basis);
        vec3 radiance(0);
        for (std::size_t k = 0; k < light.size(); ++k)
            radiance += light[k] * static_cast<float>(basis[k]);
        frame.lightNodes[n] = vec4(radiance * kShNodes[n].w, 0);
    }
    return frame;
}

} // namespace penumbra
