#include "systems/frame_constants.h"

#include "assets/sh_basis.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <utility>
#include <vector>

namespace penumbra {

namespace {

// Directions and weights that integrate products of two order-6 functions, which have degree 10,
// exactly: Gauss-Legendre in z (n nodes z_i, the roots of P_n, with the weights
// 2 / ((1 - z_i^2) P_n'(z_i)^2), up to degree 2n - 1), 11 equal turns about it.
struct SphereRule {
    static constexpr int kRows = 6, kTurns = 11;
    std::vector<glm::dvec4> points; // w: weight

    SphereRule()
    {
        for (int row = 0; row < kRows; ++row) {
            // Newton's method from Chebyshev's nodes, on the Legendre recurrence.
            double z = std::cos(std::numbers::pi * (row + 0.75) / (kRows + 0.5)), slope = 1;
            for (int iteration = 0; iteration < 20; ++iteration) {
                double previous = 1, value = z;
                for (int l = 2; l <= kRows; ++l)
                    previous =
                        std::exchange(value, ((2 * l - 1) * z * value - (l - 1) * previous) / l);
                slope = kRows * (z * value - previous) / (z * z - 1);
                z -= value / slope;
            }
            const double s = std::sqrt(1 - z * z);
            const double weight = 2 / (s * s * slope * slope) * 2 * std::numbers::pi / kTurns;
            for (int turn = 0; turn < kTurns; ++turn) {
                const double angle = 2 * std::numbers::pi * turn / kTurns;
                points.emplace_back(s * std::cos(angle), s * std::sin(angle), z, weight);
            }
        }
    }
};

using Basis6 = std::array<double, 36>;

Basis6 basis6(glm::dvec3 direction)
{
    Basis6 basis{};
    shBasisAnyOrder(6, direction, basis);
    return basis;
}

glm::dvec3 radianceOf(const LightSh& light, glm::dvec3 direction)
{
    const Basis6 basis = basis6(direction);
    glm::dvec3 radiance(0);
    for (std::size_t k = 0; k < light.size(); ++k)
        radiance += glm::dvec3(light[k]) * basis[k];
    return radiance;
}

} // namespace

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

Environment aboveGround(const Environment& environment, vec3 up)
{
    const std::uint32_t width = environment.mapWidth, height = environment.mapHeight;
    const double pixel = std::numbers::pi / height; // of a row, radians
    const glm::dvec3 zenith = glm::normalize(glm::dvec3(up));
    std::vector<double> along(width); // the part of `up` that lies flat in the map, by azimuth
    for (std::uint32_t x = 0; x < width; ++x) {
        const double azimuth = (2 * (x + 0.5) / width - 1) * std::numbers::pi;
        along[x] = std::cos(azimuth) * zenith.x + std::sin(azimuth) * zenith.z;
    }
    std::vector<vec3> map = environment.map;
    for (std::uint32_t y = 0; y < height; ++y) {
        const double polar = (y + 0.5) * pixel;
        const double upwards = std::cos(polar) * zenith.y, flat = std::sin(polar);
        for (std::uint32_t x = 0; x < width; ++x) {
            const double elevation = std::asin(std::clamp(upwards + flat * along[x], -1.0, 1.0));
            map[std::size_t{y} * width + x] *=
                static_cast<float>(std::clamp(0.5 + elevation / pixel, 0.0, 1.0));
        }
    }
    Environment clipped = makeEnvironment(width, height, std::move(map));
    clipped.statistics = environment.statistics;
    return clipped;
}

LightSh rotatedLight(const LightSh& light, const mat3& rotation)
{
    static const SphereRule kRule;
    const glm::dmat3 before = glm::transpose(glm::dmat3(rotation));
    std::array<glm::dvec3, 36> sum{};
    for (const glm::dvec4& point : kRule.points) {
        const glm::dvec3 direction(point);
        const glm::dvec3 radiance = point.w * radianceOf(light, before * direction);
        const Basis6 basis = basis6(direction);
        for (std::size_t k = 0; k < sum.size(); ++k)
            sum[k] += radiance * basis[k];
    }
    LightSh rotated;
    std::copy(sum.begin(), sum.end(), rotated.begin());
    return rotated;
}

FrameConstants frameConstants(const View& view, const LightSh& light, float backgroundIntensity)
{
    FrameConstants frame{};
    frame.clipFromWorld = view.clipFromWorld;
    frame.worldFromClip = glm::inverse(view.clipFromWorld);
    frame.eye = vec4(view.eye, 1);
    frame.backgroundIntensity = backgroundIntensity;
    frame.culls = kCullAll;

    // Planes from the rows of the matrix (Gribb and Hartmann 2001), normalised so that distances
    // are metres.
    const mat4 rows = glm::transpose(view.clipFromWorld);
    const vec4 planes[6] = {rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1],
                            rows[3] - rows[1], rows[2],           rows[3] - rows[2]};
    for (int i = 0; i < 6; ++i)
        frame.frustum[i] = planes[i] / length(vec3(planes[i]));

    for (std::size_t k = 0; k < light.size(); ++k)
        frame.light[k] = vec4(light[k], 0);
    return frame;
}

SkyNodes skyNodes(const FrameConstants& frame, const mat3& worldFromObject)
{
    SkyNodes nodes;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        const Sh6 basis = shBasis6(worldFromObject * vec3(kShNodes[n]));
        vec3 radiance(0);
        for (std::size_t k = 0; k < kLightCoefficients; ++k)
            radiance += basis.c[k] * vec3(frame.light[k]);
        nodes[n] = radiance * kShNodes[n].w;
    }
    return nodes;
}

} // namespace penumbra
