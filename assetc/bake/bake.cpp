// bakeMesh: samples of all shells and all vertices, looked up in the same line spaces
// (assetc/bake/line_space.h).
#include "assetc/bake.h"

#include "assetc/bake/directions.h"
#include "assetc/bake/line_space.h"
#include "assets/bounding_sphere.h"
#include "shaders/shared/field.h"

#include <algorithm>
#include <array>
#include <glm/gtc/constants.hpp>
#include <tbb/parallel_for.h>

namespace penumbra {

namespace {

constexpr std::size_t kBatch =
    16; // direction pairs rasterised before looking up: 16 x 2 MiB of lines, 32 bits a point
constexpr std::size_t kBlock = 256; // points per task

using Coefficients = std::array<float, 16>;

PointSet shellPoints(const BakeOptions& options, const ShadowField& field)
{
    PointSet points;
    const float last = static_cast<float>(options.side - 1);
    for (std::uint32_t s = 0; s < options.shells; ++s) {
        const float r = shellRadius(field, s);
        for (std::uint32_t y = 0; y < options.side; ++y) {
            for (std::uint32_t x = 0; x < options.side; ++x) {
                const vec3 p = r * octahedralDirection(
                                       vec2(static_cast<float>(x), static_cast<float>(y)) / last);
                points.x.push_back(p.x);
                points.y.push_back(p.y);
                points.z.push_back(p.z);
            }
        }
    }
    return points;
}

PointSet normalised(const std::vector<vec3>& points, const Sphere& sphere)
{
    PointSet out;
    for (const vec3& point : points) {
        const vec3 p = (point - sphere.center) / sphere.radius;
        out.x.push_back(p.x);
        out.y.push_back(p.y);
        out.z.push_back(p.z);
    }
    return out;
}

// Adds the basis of every blocked direction of the batch to each point's sum. `normals`, where
// given, drops directions below a point's tangent plane. The order of additions depends on nothing
// but the point, so any thread count gives the same bits.
void accumulate(const std::vector<LineSpace>& lines, const std::vector<vec3>& directions,
                const std::vector<Sh4>& basis, std::size_t firstPair, std::size_t pairs,
                const PointSet& points, const std::vector<vec3>* normals,
                std::vector<Coefficients>& sums)
{
    const std::size_t half = directions.size() / 2;
    tbb::parallel_for(
        std::size_t{0}, (points.size() + kBlock - 1) / kBlock, [&](std::size_t block) {
            const std::size_t begin = block * kBlock,
                              count = std::min(kBlock, points.size() - begin);
            std::array<std::uint8_t, kBlock> blocked;
            for (std::size_t b = 0; b < pairs; ++b) {
                if (!lines[b].lookUp(points, begin, count, blocked.data()))
                    continue;
                const std::size_t plus = firstPair + b;
                for (std::size_t i = 0; i < count; ++i) {
                    int bits = blocked[i];
                    if (bits == 0)
                        continue;
                    if (normals)
                        bits &= dot((*normals)[begin + i], directions[plus]) > 0 ? 1 : 2;
                    Coefficients& sum = sums[begin + i];
                    for (int sign = 0; sign < 2; ++sign) {
                        if ((bits >> sign & 1) == 0)
                            continue;
                        const Sh4& y = basis[plus + (sign == 1 ? half : 0)];
                        for (std::size_t k = 0; k < 16; ++k)
                            sum[k] += y.c[k];
                    }
                }
            }
        });
}

std::uint8_t quantise(float steps)
{
    return static_cast<std::uint8_t>(std::clamp(std::lround(steps) + 128L, 1L, 255L));
}

std::size_t bandOf(std::size_t coefficient)
{
    return coefficient < 1 ? 0 : coefficient < 4 ? 1 : coefficient < 9 ? 2 : 3;
}

// Scales and bytes from the deviations -sum * 4 pi / n. `blocked` is [shell][y][x].
void quantiseField(const std::vector<Coefficients>& blocked, const PointSet& points, float weight,
                   ShadowField& field)
{
    std::vector<float> invDecay(points.size());
    std::array<float, 4> largest{};
    for (std::size_t i = 0; i < points.size(); ++i) {
        const float r2 =
            points.x[i] * points.x[i] + points.y[i] * points.y[i] + points.z[i] * points.z[i];
        invDecay[i] = 1 / fieldDecay(r2);
        for (std::size_t k = 0; k < 16; ++k)
            largest[bandOf(k)] =
                std::max(largest[bandOf(k)], std::abs(blocked[i][k] * weight * invDecay[i]));
    }
    for (std::size_t l = 0; l < 4; ++l)
        field.bandScale[l] =
            std::max(largest[l] / 127, 1e-6f); // never 0: a mesh that hides nothing still decodes
    field.texels.resize(points.size() * 16);
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t k = 0; k < 16; ++k)
            field.texels[16 * i + k] =
                quantise(-blocked[i][k] * weight * invDecay[i] / field.bandScale[bandOf(k)]);
}

} // namespace

BakeResult bakeMesh(const std::vector<vec3>& positions, const std::vector<vec3>& normals,
                    const std::vector<std::uint32_t>& indices, const BakeOptions& options,
                    Progress& progress)
{
    PENUMBRA_ASSERT(!positions.empty() && positions.size() == normals.size(),
                    "{} positions, {} normals", positions.size(), normals.size());
    PENUMBRA_ASSERT(options.shells >= 2 && options.side >= 3, "{} shells of side {}",
                    options.shells, options.side);

    const Sphere sphere = boundingSphere(positions, 64);
    const PointSet vertices = normalised(positions, sphere);

    BakeResult result;
    ShadowField& field = result.field;
    field.center = sphere.center;
    field.radius = sphere.radius;
    field.directions = options.directions;
    field.shellSides.assign(options.shells, static_cast<std::uint16_t>(options.side));
    const PointSet samples = options.field ? shellPoints(options, field) : PointSet{};

    // A vertex lies on the surface that the raster knows only per line: lifted by the half diagonal
    // of a pixel along its normal, a flat surface never blocks itself (the pixel's line is off by
    // at most that much).
    const float pixel = 2.0f / static_cast<float>(options.rasterSide);
    PointSet receivers = vertices;
    for (std::size_t i = 0; i < normals.size(); ++i) {
        receivers.x[i] += normals[i].x * pixel * 0.75f;
        receivers.y[i] += normals[i].y * pixel * 0.75f;
        receivers.z[i] += normals[i].z * pixel * 0.75f;
    }

    const std::vector<vec3> directions = bakeDirections(options.directions);
    std::vector<Sh4> basis;
    for (const vec3& d : directions)
        basis.push_back(shBasis(d));

    std::vector<Coefficients> sampleSums(samples.size()), receiverSums(receivers.size());
    std::vector<LineSpace> lines(kBatch, LineSpace(options.rasterSide));
    const std::size_t pairs = directions.size() / 2;
    progress.begin("bake", pairs);
    for (std::size_t first = 0; first < pairs; first += kBatch) {
        const std::size_t count = std::min(kBatch, pairs - first);
        tbb::parallel_for(std::size_t{0}, count, [&](std::size_t b) {
            lines[b].rasterise(directions[first + b], vertices, indices);
        });
        accumulate(lines, directions, basis, first, count, samples, nullptr, sampleSums);
        accumulate(lines, directions, basis, first, count, receivers, &normals, receiverSums);
        progress.step(count);
    }

    const float weight = 4 * glm::pi<float>() / static_cast<float>(options.directions);
    quantiseField(sampleSums, samples, weight, field);
    result.selfVisibility.resize(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i)
        for (std::size_t k = 0; k < 16; ++k)
            result.selfVisibility[i][k] =
                quantise(-receiverSums[i][k] * weight / kSelfVisibilityScale);
    return result;
}

} // namespace penumbra
