#include "assetc/environment.h"

#include "assetc/file_type.h"
#include "assetc/words.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

namespace penumbra {

namespace {

// Each step lowers one pixel; maps with more absurd pixels than this are noise, and bounded by the
// half floats anyway.
constexpr int kMaxAbsurdSteps = 64;

struct Filter {
    std::uint32_t width, height; // of the map
    double scaleX, scaleY;       // source pixels per map pixel, >= 1
};

Filter mapFilter(const EnvironmentSource& source)
{
    const std::uint32_t width = std::min(source.width, kMaxEnvironmentWidth);
    const std::uint32_t height = std::min(source.height, kMaxEnvironmentHeight);
    return {width, height, static_cast<double>(source.width) / width,
            static_cast<double>(source.height) / height};
}

float maxChannel(vec3 c)
{
    return std::max({c.r, c.g, c.b});
}

void removeNegative(EnvironmentSource& source, EnvironmentStatistics& statistics)
{
    for (vec3& pixel : source.pixels) {
        bool mended = false;
        for (int i = 0; i < 3; ++i) {
            if (!(pixel[i] >= 0.0f)) { // NaN too
                pixel[i] = 0.0f;
                mended = true;
            }
        }
        statistics.negative += mended;
    }
}

void lower(vec3& pixel, float scale, EnvironmentStatistics& statistics)
{
    pixel *= scale;
    ++statistics.absurd;
    statistics.clampedAt = statistics.clampedAt == 0.0f
                               ? luminance(pixel)
                               : std::min(statistics.clampedAt, luminance(pixel));
}

void lowerAbsurd(EnvironmentSource& source, const Filter& filter, EnvironmentStatistics& statistics)
{
    // (1) The brightest source pixel whose share of a map pixel a half float still holds. Infinity
    // has no hue.
    const auto limit = static_cast<float>(kMaxEnvironmentRadiance * filter.scaleX * filter.scaleY);
    for (vec3& pixel : source.pixels) {
        if (maxChannel(pixel) <= limit)
            continue;
        for (int i = 0; i < 3; ++i)
            pixel[i] = std::isinf(pixel[i]) ? std::numeric_limits<float>::max() : pixel[i];
        lower(pixel, limit / maxChannel(pixel), statistics);
    }
    // (2) One pixel against the rest.
    std::vector<double> solidAngle(source.height);
    for (std::uint32_t y = 0; y < source.height; ++y)
        solidAngle[y] = equirectPixelSolidAngle(source.width, source.height, y);
    for (int step = 0; step < kMaxAbsurdSteps; ++step) {
        double total = 0.0, most = 0.0;
        std::size_t brightest = 0;
        for (std::size_t i = 0; i < source.pixels.size(); ++i) {
            const double power = luminance(source.pixels[i]) * solidAngle[i / source.width];
            total += power;
            if (power > most) {
                most = power;
                brightest = i;
            }
        }
        vec3& pixel = source.pixels[brightest];
        const double rest = (total - most) / solidAngle[brightest / source.width];
        const double lowest = std::max(rest, static_cast<double>(kAbsurdLuminance));
        const double scale = lowest / luminance(pixel);
        if (!(scale < 1.0 - 1e-6)) // the rounding of the scaled pixel must not make it absurd again
            break;
        lower(pixel, static_cast<float>(scale), statistics);
    }
}

// Averages over the overlap of each source pixel with the map pixel, rows by their solid angle: cos
// is exact at the borders of the map's rows, also where those cut a source row.
std::vector<vec3> boxFilter(const EnvironmentSource& source, const Filter& filter)
{
    std::vector<vec3> map(std::size_t{filter.width} * filter.height);
    std::vector<glm::dvec3> row(filter.width);
    for (std::uint32_t y = 0; y < filter.height; ++y) {
        std::fill(row.begin(), row.end(), glm::dvec3(0.0));
        double rowWeight = 0.0;
        const double top = y * filter.scaleY,
                     bottom = std::min<double>((y + 1) * filter.scaleY, source.height);
        for (auto sy = static_cast<std::uint32_t>(top); sy < bottom; ++sy) {
            const double from = std::max<double>(top, sy), to = std::min<double>(bottom, sy + 1.0);
            const double weight = std::cos(std::numbers::pi * from / source.height) -
                                  std::cos(std::numbers::pi * to / source.height);
            rowWeight += weight;
            for (std::uint32_t x = 0; x < filter.width; ++x) {
                const double left = x * filter.scaleX;
                const double right = std::min<double>((x + 1) * filter.scaleX, source.width);
                for (auto sx = static_cast<std::uint32_t>(left); sx < right; ++sx) {
                    const double overlap =
                        std::min<double>(right, sx + 1.0) - std::max<double>(left, sx);
                    row[x] += weight * overlap *
                              glm::dvec3(source.pixels[std::size_t{sy} * source.width + sx]);
                }
            }
        }
        for (std::uint32_t x = 0; x < filter.width; ++x)
            map[y * filter.width + x] =
                min(vec3(row[x] / (rowWeight * filter.scaleX)), vec3(kMaxEnvironmentRadiance));
    }
    return map;
}

} // namespace

Result<EnvironmentSource> readEnvironmentSource(const std::filesystem::path& path)
{
    const auto bytes = readInput(path, FileType::EnvironmentSource, kMaxPictureBytes);
    if (!bytes)
        return bytes.error();
    const bool radiance = bytes->front() == std::byte{'#'};
    auto source = radiance ? decodeRadianceHdr(*bytes) : decodeOpenExr(*bytes);
    if (!source)
        return fail(source.error(), path.string());
    const std::int64_t skew = std::int64_t{source->width} - 2 * std::int64_t{source->height};
    if (std::abs(skew) > 1)
        return Error{
            fmt::format("{}: {} x {} pixels; an equirectangular map is twice as wide as high",
                        path.string(), source->width, source->height)};
    return source;
}

Environment environmentFromSource(EnvironmentSource source)
{
    PENUMBRA_ASSERT(source.width >= 1 && source.height >= 1 &&
                        source.pixels.size() == std::size_t{source.width} * source.height,
                    "a source of {} x {} with {} pixels", source.width, source.height,
                    source.pixels.size());
    const Filter filter = mapFilter(source);
    EnvironmentStatistics statistics;
    removeNegative(source, statistics);
    lowerAbsurd(source, filter, statistics);
    Environment environment =
        makeEnvironment(filter.width, filter.height, boxFilter(source, filter));
    environment.statistics.sourceWidth = source.width;
    environment.statistics.sourceHeight = source.height;
    environment.statistics.negative = statistics.negative;
    environment.statistics.absurd = statistics.absurd;
    environment.statistics.clampedAt = statistics.clampedAt;
    return environment;
}

Result<Environment> importEnvironment(const std::filesystem::path& path)
{
    Result<EnvironmentSource> source = readEnvironmentSource(path);
    if (!source)
        return source.error();
    return environmentFromSource(std::move(*source));
}

std::vector<std::string> environmentWarnings(const EnvironmentStatistics& statistics)
{
    std::vector<std::string> warnings;
    std::string text;
    if (statistics.negative > 0)
        text = counted(statistics.negative, "pixel") + " with a negative channel";
    if (statistics.absurd > 0)
        text += (text.empty() ? "" : " and ") + counted(statistics.absurd, "absurd pixel");
    const bool one = statistics.negative + statistics.absurd == 1;
    if (!text.empty())
        warnings.push_back(text + (one ? " was clamped" : " were clamped"));
    if (!(statistics.maxLuminance > 0))
        warnings.emplace_back("the map is black and lights nothing; check what it was saved from");
    return warnings;
}

std::string environmentReport(const Environment& environment)
{
    const EnvironmentStatistics& statistics = environment.statistics;
    nlohmann::ordered_json report;
    report["map"] = {environment.mapWidth, environment.mapHeight};
    report["source"] = {statistics.sourceWidth, statistics.sourceHeight};
    report["negative"] = statistics.negative;
    report["absurd"] = statistics.absurd;
    report["clampedAt"] = statistics.clampedAt;
    report["meanLuminance"] = statistics.meanLuminance;
    report["maxLuminance"] = statistics.maxLuminance;
    report["energyShare"] = {{"order4", environmentEnergyShare(environment, 4)},
                             {"order6", environmentEnergyShare(environment, 6)}};
    for (const vec3& c : environment.sh4)
        report["sh4"].push_back({c.r, c.g, c.b});
    return report.dump(2) + "\n";
}

} // namespace penumbra
