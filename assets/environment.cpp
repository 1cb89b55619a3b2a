#include "assets/environment.h"

#include "assets/sh_basis.h"
#include "shaders/shared/environment.h"

#include <algorithm>
#include <glm/gtc/packing.hpp>

namespace penumbra {

namespace {

// Projection samples at least this many rows, so that the basis is as good as constant over a
// sample (1.4 degrees at most) however small the map.
constexpr std::uint32_t kProjectionRows = 256;

float roundToHalf(float value)
{
    return glm::unpackHalf1x16(glm::packHalf1x16(value));
}

vec3 roundToHalf(vec3 value)
{
    return {roundToHalf(value.r), roundToHalf(value.g), roundToHalf(value.b)};
}

bool validRadiance(vec3 c)
{
    const auto valid = [](float x) { return x >= 0.0f && x <= kMaxEnvironmentRadiance; };
    return valid(c.r) && valid(c.g) && valid(c.b);
}

void project(Environment& environment)
{
    const std::uint32_t width = environment.mapWidth, height = environment.mapHeight;
    const std::uint32_t splitY = (kProjectionRows + height - 1) / height;
    const std::uint32_t splitX = (2 * kProjectionRows + width - 1) / width;
    std::array<glm::dvec3, 36> sum{};
    std::array<double, 36> basis{};
    for (std::uint32_t fine = 0; fine < height * splitY; ++fine) {
        const double weight = equirectPixelSolidAngle(width * splitX, height * splitY, fine);
        const double polar = (fine + 0.5) / (height * splitY) * std::numbers::pi;
        for (std::uint32_t x = 0; x < width; ++x) {
            const glm::dvec3 radiance(environment.map[fine / splitY * width + x]);
            if (radiance == glm::dvec3(0))
                continue; // half of a map that was cut at the horizon
            for (std::uint32_t i = 0; i < splitX; ++i) {
                const double u = (x * splitX + i + 0.5) / (width * splitX);
                const double azimuth = (2.0 * u - 1.0) * std::numbers::pi;
                shBasisAnyOrder(6,
                                {std::sin(polar) * std::cos(azimuth), std::cos(polar),
                                 std::sin(polar) * std::sin(azimuth)},
                                basis);
                for (std::size_t k = 0; k < basis.size(); ++k)
                    sum[k] += weight * basis[k] * radiance;
            }
        }
    }
    for (std::size_t k = 0; k < sum.size(); ++k)
        environment.sh6[k] = vec3(sum[k]);
    std::copy_n(environment.sh6.begin(), environment.sh4.size(), environment.sh4.begin());
}

} // namespace

double equirectPixelSolidAngle(std::uint32_t width, std::uint32_t height, std::uint32_t y)
{
    const double top = std::cos(std::numbers::pi * y / height);
    const double bottom = std::cos(std::numbers::pi * (y + 1) / height);
    return 2.0 * std::numbers::pi / width * (top - bottom);
}

Environment makeEnvironment(std::uint32_t width, std::uint32_t height, std::vector<vec3> map)
{
    PENUMBRA_ASSERT(width >= 1 && width <= kMaxEnvironmentWidth && height >= 1 &&
                        height <= kMaxEnvironmentHeight &&
                        map.size() == std::size_t{width} * height,
                    "a map of {} x {} with {} pixels", width, height, map.size());
    Environment environment;
    environment.mapWidth = width;
    environment.mapHeight = height;
    environment.map = std::move(map);
    EnvironmentStatistics& statistics = environment.statistics;
    statistics.sourceWidth = width;
    statistics.sourceHeight = height;
    double mean = 0.0;
    for (std::uint32_t y = 0; y < height; ++y) {
        double row = 0.0;
        for (std::uint32_t x = 0; x < width; ++x) {
            vec3& pixel = environment.map[y * width + x];
            PENUMBRA_ASSERT(validRadiance(pixel), "pixel ({}, {}) is ({}, {}, {})", x, y, pixel.r,
                            pixel.g, pixel.b);
            pixel = roundToHalf(pixel);
            row += luminance(pixel);
            statistics.maxLuminance = std::max(statistics.maxLuminance, luminance(pixel));
        }
        mean += row * equirectPixelSolidAngle(width, height, y);
    }
    statistics.meanLuminance = static_cast<float>(mean / (4.0 * std::numbers::pi));
    project(environment);
    return environment;
}

double environmentEnergyShare(const Environment& environment, int order)
{
    PENUMBRA_ASSERT(order >= 1 && order <= 6, "order {}", order);
    double all = 0.0, held = 0.0;
    for (std::uint32_t y = 0; y < environment.mapHeight; ++y) {
        double row = 0.0;
        for (std::uint32_t x = 0; x < environment.mapWidth; ++x) {
            const glm::dvec3 c(environment.map[y * environment.mapWidth + x]);
            row += glm::dot(c, c);
        }
        all += row * equirectPixelSolidAngle(environment.mapWidth, environment.mapHeight, y);
    }
    for (int k = 0; k < order * order; ++k)
        held += glm::dot(glm::dvec3(environment.sh6[k]), glm::dvec3(environment.sh6[k]));
    return all > 0.0 ? std::min(1.0, held / all) : 1.0;
}

} // namespace penumbra
