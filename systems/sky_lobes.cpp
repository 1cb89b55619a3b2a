#include "systems/sky_lobes.h"

#include "runtime/assert.h"
#include "shaders/shared/environment.h"
#include "shaders/shared/instance.h"

#include <algorithm>
#include <numbers>
#include <tbb/parallel_for.h>

namespace penumbra {

namespace {

constexpr double kPi = std::numbers::pi;

// The map in fewer pixels, and what the sums over them need.
struct Mip {
    std::uint32_t width = 0, height = 0;
    std::vector<vec3> radiance;   // [height][width]
    std::vector<vec3> directions; // [height][width], of the pixels' centres
    std::vector<float> weights;   // [height] solid angle of a pixel, sr
};

Mip makeMip(std::uint32_t width, std::uint32_t height, std::vector<vec3> radiance)
{
    Mip mip{width, height, std::move(radiance), {}, {}};
    for (std::uint32_t y = 0; y < height; ++y) {
        mip.weights.push_back(static_cast<float>(equirectPixelSolidAngle(width, height, y)));
        for (std::uint32_t x = 0; x < width; ++x)
            mip.directions.push_back(
                equirectDirection((vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5f) /
                                  vec2(static_cast<float>(width), static_cast<float>(height))));
    }
    return mip;
}

Mip halved(const Mip& fine)
{
    std::vector<vec3> radiance;
    for (std::uint32_t y = 0; y < fine.height; y += 2)
        for (std::uint32_t x = 0; x < fine.width; x += 2) {
            const vec3* const p = &fine.radiance[std::size_t{y} * fine.width + x];
            const float upper = fine.weights[y], lower = fine.weights[y + 1];
            radiance.push_back(
                (upper * (p[0] + p[1]) + lower * (p[fine.width] + p[fine.width + 1])) /
                (2 * (upper + lower)));
        }
    return makeMip(fine.width / 2, fine.height / 2, std::move(radiance));
}

// Sum of the weights and of weight times radiance, by t^(4 2^level + 1).
struct LobeSum {
    vec3 direction;
    std::uint32_t level;
    vec3 radiance{0};
    float weight = 0;

    void add(const Mip& mip, std::uint32_t row, std::uint32_t first, std::uint32_t last)
    {
        const std::size_t start = std::size_t{row} * mip.width;
        for (std::size_t i = start + first; i < start + last; ++i) {
            const float t = std::max(dot(mip.directions[i], direction), 0.0f);
            float power = t * t;
            for (std::uint32_t k = 0; k <= level; ++k)
                power *= power;
            power *= t * mip.weights[row];
            radiance += power * mip.radiance[i];
            weight += power;
        }
    }
};

// Over the pixels where the lobe is more than 1e-4 of its peak.
vec3 lobeMean(const Mip& mip, vec3 direction, std::uint32_t level)
{
    const double cosine = std::pow(1e-4, 1 / (static_cast<double>(4u << level) + 1));
    const double reach = std::acos(cosine), pixel = kPi / mip.height;
    const double polar = std::acos(std::clamp(static_cast<double>(direction.y), -1.0, 1.0));
    const double column =
        static_cast<double>(equirectUv(direction).x) * mip.width - 0.5; // of the direction
    const auto clampRow = [&](double row) {
        return static_cast<std::uint32_t>(std::clamp(row, 0.0, static_cast<double>(mip.height)));
    };
    LobeSum sum{direction, level};
    const std::uint32_t lastRow = clampRow(std::ceil((polar + reach) / pixel) + 1);
    for (std::uint32_t y = clampRow((polar - reach) / pixel - 1); y < lastRow; ++y) {
        const double rowPolar = (y + 0.5) * pixel;
        const double sines = std::sin(rowPolar) * std::sin(polar);
        const double turn = // cosine of the azimuth that the lobe reaches in this row
            (cosine - std::cos(rowPolar) * std::cos(polar)) / std::max(sines, 1e-9);
        const double half = turn >= 1 ? 0 : turn <= -1 ? kPi : std::acos(turn);
        const double columns = half / (2 * kPi) * mip.width + 1;
        if (2 * columns + 3 >= mip.width) {
            sum.add(mip, y, 0, mip.width);
            continue;
        }
        const auto first = static_cast<std::int64_t>(std::floor(column - columns));
        const auto last = static_cast<std::int64_t>(std::ceil(column + columns)) + 1;
        const auto width = static_cast<std::int64_t>(mip.width);
        const auto range = [&](std::int64_t from, std::int64_t to) {
            if (from < to)
                sum.add(mip, y, static_cast<std::uint32_t>(from), static_cast<std::uint32_t>(to));
        };
        range(std::max<std::int64_t>(first, 0), std::min(last, width));
        range(first + width, std::min(width, last + width)); // what lies left of the first column
        range(0, last - width);                              // and right of the last
    }
    if (sum.weight > 0)
        return sum.radiance / sum.weight;
    const vec2 uv = equirectUv(direction); // the lobe fits between the centres of pixels
    const auto at = [](float place, std::uint32_t count) {
        return std::min(static_cast<std::uint32_t>(place * static_cast<float>(count)), count - 1);
    };
    return mip.radiance[std::size_t{at(uv.y, mip.height)} * mip.width + at(uv.x, mip.width)];
}

std::size_t nodeCount(std::uint32_t level)
{
    return std::size_t{skyLobeSide(level)} * skyLobeSide(level);
}

vec3 nodeDirection(std::uint32_t level, std::size_t node)
{
    const std::uint32_t side = skyLobeSide(level);
    const std::size_t column = node % side, row = node / side;
    const vec2 at(static_cast<float>(column), static_cast<float>(row));
    return octahedralDirection(at / static_cast<float>(side - 1));
}

vec4 blended(const SkyLobes& sky, const SkyLobeCell& cell)
{
    const vec4* const at = &sky.texels[cell.texel];
    return mix(mix(at[0], at[1], cell.fraction.x),
               mix(at[cell.side], at[cell.side + 1], cell.fraction.x), cell.fraction.y);
}

static_assert(kSkyLobeTexels == 2 * 65 * 65 + 7 * 129 * 129);

} // namespace

SkyLobes filterSky(const Environment& environment)
{
    std::vector<Mip> mips; // the finest first
    mips.push_back(makeMip(environment.mapWidth, environment.mapHeight, environment.map));
    while (mips.back().width % 2 == 0 && mips.back().height % 2 == 0)
        mips.push_back(halved(mips.back()));
    SkyLobes lobes{std::vector<vec4>(kSkyLobeTexels)};
    for (std::uint32_t level = 0; level < kSkyLobeLevels; ++level) {
        // A lobe is about 1 / sqrt(exponent) wide; pixels of 0.4 times that are fine enough.
        const float columns = 16 * std::sqrt(static_cast<float>(4u << level));
        std::size_t m = 0;
        while (m + 1 < mips.size() && static_cast<float>(mips[m + 1].width) >= columns)
            ++m;
        tbb::parallel_for(std::size_t{0}, nodeCount(level), [&](std::size_t node) {
            lobes.texels[skyLobeFirst(level) + node] =
                vec4(lobeMean(mips[m], nodeDirection(level, node), level), 0);
        });
    }
    return lobes;
}

vec3 filteredSky(const SkyLobes& sky, vec3 direction, float exponent)
{
    PENUMBRA_ASSERT(sky.texels.size() == kSkyLobeTexels, "{} texels", sky.texels.size());
    const float level = skyLobeLevel(exponent);
    const std::uint32_t lower = std::min(static_cast<std::uint32_t>(level), kSkyLobeLevels - 2);
    return vec3(mix(blended(sky, skyLobeCell(direction, lower)),
                    blended(sky, skyLobeCell(direction, lower + 1)),
                    level - static_cast<float>(lower)));
}

void addTurned(SkyLobes& sum, const SkyLobes& sky, float intensity, vec4 rotation)
{
    sum.texels.resize(kSkyLobeTexels);
    if (rotation == vec4(0, 0, 0, 1)) {
        for (std::size_t i = 0; i < kSkyLobeTexels; ++i)
            sum.texels[i] += intensity * sky.texels[i];
        return;
    }
    const vec4 back(-vec3(rotation), rotation.w);
    for (std::uint32_t level = 0; level < kSkyLobeLevels; ++level)
        tbb::parallel_for(std::size_t{0}, nodeCount(level), [&](std::size_t node) {
            sum.texels[skyLobeFirst(level) + node] +=
                intensity *
                blended(sky, skyLobeCell(rotate(back, nodeDirection(level, node)), level));
        });
}

} // namespace penumbra
