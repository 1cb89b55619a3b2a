#include "systems/sky_beams.h"

#include "shaders/shared/environment.h"

#include <algorithm>
#include <span>

namespace penumbra {

namespace {

struct BrightPixel {
    glm::dvec3 direction;
    glm::dvec3 irradiance; // radiance times solid angle
    double power;          // luminance of it
};

std::vector<BrightPixel> brightPixels(const Environment& bright)
{
    std::vector<BrightPixel> pixels;
    const vec2 size(bright.mapWidth, bright.mapHeight);
    for (std::uint32_t y = 0; y < bright.mapHeight; ++y) {
        const double angle = equirectPixelSolidAngle(bright.mapWidth, bright.mapHeight, y);
        for (std::uint32_t x = 0; x < bright.mapWidth; ++x) {
            const vec3 radiance = bright.map[y * bright.mapWidth + x];
            if (radiance == vec3(0))
                continue;
            pixels.push_back({glm::dvec3(equirectDirection((vec2(x, y) + 0.5f) / size)),
                              angle * glm::dvec3(radiance), angle * luminance(radiance)});
        }
    }
    return pixels;
}

// Neighbouring pixels, with their moments.
struct Region {
    std::span<BrightPixel> pixels;
    double power = 0;
    glm::dvec3 mean{0}; // of the directions, by power
    glm::dvec3 axis{0}; // of the largest variance
    double variance = 0;

    explicit Region(std::span<BrightPixel> of) : pixels(of)
    {
        for (const BrightPixel& p : pixels) {
            power += p.power;
            mean += p.power * p.direction;
        }
        mean /= power;
        glm::dmat3 covariance(0);
        for (const BrightPixel& p : pixels) {
            const glm::dvec3 d = p.direction - mean;
            covariance += glm::outerProduct(p.power * d, d);
        }
        covariance /= power;
        // Power iteration; a start that happens to lie across the axis is turned by rounding soon.
        axis = glm::normalize(glm::dvec3(1, 0.7, 0.3));
        for (int k = 0; k < 32; ++k)
            if (const glm::dvec3 next = covariance * axis; glm::length(next) > 0)
                axis = glm::normalize(next);
        variance = glm::dot(axis, covariance * axis);
    }

    [[nodiscard]] SkyBeam beam() const
    {
        glm::dvec3 irradiance(0);
        for (const BrightPixel& p : pixels)
            irradiance += p.irradiance;
        // A disc's mean square distance from its centre is half its radius' square.
        const double meanSquare = std::max(1 - glm::dot(mean, mean), 0.0);
        // Lights all around have no direction: any will do.
        const double along = glm::length(mean);
        const glm::dvec3 direction = along > 1e-6 ? mean / along : pixels.front().direction;
        return {vec3(direction), vec3(along * irradiance),
                static_cast<float>(std::min(std::sqrt(2 * meanSquare), 1.0))};
    }
};

// The first half: at least one pixel, and not all.
std::size_t halve(const Region& region)
{
    std::stable_sort(region.pixels.begin(), region.pixels.end(),
                     [&](const BrightPixel& a, const BrightPixel& b) {
                         return glm::dot(region.axis, a.direction) <
                                glm::dot(region.axis, b.direction);
                     });
    double power = 0;
    std::size_t first = 0;
    while (first + 1 < region.pixels.size() && (first == 0 || power < region.power / 2))
        power += region.pixels[first++].power;
    return first;
}

std::vector<SkyBeam> medianCut(std::vector<BrightPixel> pixels, std::uint32_t count)
{
    if (pixels.empty())
        return {};
    std::vector<Region> regions{Region(pixels)};
    while (regions.size() < count) {
        const auto widest =
            std::max_element(regions.begin(), regions.end(), [](const Region& a, const Region& b) {
                return a.power * a.variance < b.power * b.variance;
            });
        const Region whole = *widest;
        if (whole.pixels.size() < 2)
            break;
        const std::size_t first = halve(whole);
        *widest = Region(whole.pixels.first(first));
        regions.emplace_back(whole.pixels.subspan(first));
    }
    std::vector<SkyBeam> beams;
    for (const Region& region : regions)
        beams.push_back(region.beam());
    return beams;
}

} // namespace

SkySplit splitSky(Environment environment, std::uint32_t count)
{
    if (count == 0)
        return {std::move(environment), {}, {}};
    const float limit = kBrightSky * environment.statistics.meanLuminance;
    std::vector<vec3> rest = std::move(environment.map);
    std::vector<vec3> bright(rest.size(), vec3(0));
    for (std::size_t i = 0; i < rest.size(); ++i) {
        const float value = luminance(rest[i]);
        if (value <= limit)
            continue;
        bright[i] = rest[i] * (1 - limit / value);
        rest[i] *= limit / value;
    }
    SkySplit split{makeEnvironment(environment.mapWidth, environment.mapHeight, std::move(rest)),
                   makeEnvironment(environment.mapWidth, environment.mapHeight, std::move(bright)),
                   {}};
    split.beams = medianCut(brightPixels(split.bright), count);
    return split;
}

} // namespace penumbra
