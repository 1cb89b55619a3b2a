// bakeMesh: samples of all shells and all vertices, looked up in the same line spaces
// (assetc/bake/line_space.h).
#include "assetc/bake.h"

#include "assetc/bake/directions.h"
#include "assetc/bake/fill_inside.h"
#include "assetc/bake/point_blocks.h"
#include "assets/bounding_sphere.h"

#include <algorithm>
#include <array>
#include <glm/gtc/constants.hpp>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

namespace penumbra {

namespace {

constexpr std::size_t kBatch =
    16; // direction pairs rasterised before looking up: 16 x 1 MiB of lines

struct BakeDirections {
    std::vector<vec3> directions; // antipodal halves
    std::vector<Sh4> basis;
    float cellHalfWidth = 0; // of the square with the solid angle of a direction

    explicit BakeDirections(std::uint32_t count) : directions(bakeDirections(count))
    {
        for (const vec3& d : directions)
            basis.push_back(shBasis(d));
        cellHalfWidth = std::sqrt(glm::pi<float>() / static_cast<float>(count));
    }
    [[nodiscard]] std::size_t pairs() const { return directions.size() / 2; }
};

// Integral of the basis over the blocked directions of each point, built up batch by batch.
struct Receivers {
    PointBlocks points;
    std::vector<vec3> normals;     // where given, directions below a point's tangent plane are free
    std::vector<Sh4> blocked;      // [points]
    std::vector<Sh4> blockedByOdd; // [points] where wanted: the part of every other direction
};

// Outside this radius a point asks for the whole cell of a direction, which has half of the noise
// there and a fifth far away (docs/decisions/0006); inside, what is blocked lies at too many
// distances.
constexpr float kCellRadius = 1.03f;

// The order of additions depends on nothing but the point, so any thread count gives the same bits.
void accumulate(const std::vector<LineSpace>& lines, const BakeDirections& bake,
                std::size_t firstPair, std::size_t pairs, Receivers& receivers)
{
    const float cellWeight = 4 * glm::pi<float>() / static_cast<float>(bake.directions.size());
    tbb::parallel_for(std::size_t{0}, receivers.points.blocks.size(), [&](std::size_t i) {
        const PointBlock& block = receivers.points.blocks[i];
        const float cell = block.nearest > kCellRadius ? bake.cellHalfWidth : 0;
        LineSpace::BlockedParts blocked;
        for (std::size_t b = 0; b < pairs; ++b) {
            const std::size_t plus = firstPair + b;
            std::vector<Sh4>& sums = plus % 2 == 1 && !receivers.blockedByOdd.empty()
                                         ? receivers.blockedByOdd
                                         : receivers.blocked;
            const vec3 w = bake.directions[plus];
            if (!mayMeetUnitSphere(block, w, cell) ||
                !lines[b].lookUp(receivers.points.points, block.begin, block.count, cell, blocked))
                continue;
            for (int sign = 0; sign < 2; ++sign) {
                const Sh4& y = bake.basis[plus + (sign == 1 ? bake.pairs() : 0)];
                for (std::size_t p = 0; p < block.count; ++p) {
                    const std::size_t point = block.begin + p;
                    if (blocked[sign][p] <= 0)
                        continue;
                    if (!receivers.normals.empty() &&
                        (dot(receivers.normals[point], w) > 0) != (sign == 0))
                        continue;
                    const float part = blocked[sign][p] * cellWeight;
                    for (std::size_t k = 0; k < 16; ++k)
                        sums[point].c[k] += part * y.c[k];
                }
            }
        }
    });
}

// A vertex lies on the surface that the raster knows only per line: lifted by three quarters of a
// pixel along its normal, a flat surface never blocks itself (the pixel's line is off by at most
// half a diagonal).
Receivers liftedVertices(const PointSet& vertices, const std::vector<vec3>& normals, float pixel)
{
    Receivers receivers;
    receivers.normals = normals;
    for (std::size_t i = 0; i < normals.size(); ++i)
        receivers.points.add(vec3(vertices.x[i], vertices.y[i], vertices.z[i]) +
                             normals[i] * (pixel * 0.75f));
    receivers.points.endBlock();
    receivers.blocked.resize(normals.size());
    return receivers;
}

SelfVisibility quantiseSelfVisibility(const Sh4& blocked)
{
    SelfVisibility bytes;
    for (std::size_t k = 0; k < 16; ++k)
        bytes[k] = static_cast<std::uint8_t>(
            std::clamp(std::lround(-blocked.c[k] / kSelfVisibilityScale) + 128L, 1L, 255L));
    return bytes;
}

void readProbes(const Receivers& offGrid, std::vector<Probe>& probes)
{
    for (std::size_t i = 0; i < 3 * probes.size(); ++i) {
        Probe& probe = probes[i / 3];
        const Sh4 &even = offGrid.blocked[i], &odd = offGrid.blockedByOdd[i];
        Sh4& value = i % 3 == 0 ? probe.exact : i % 3 == 1 ? probe.low : probe.high;
        for (int k = 0; k < 16; ++k) {
            value.c[k] = -(even.c[k] + odd.c[k]);
            if (i % 3 == 0) // half the difference of two fields of half the directions each
                probe.noise.c[k] = even.c[k] - odd.c[k];
        }
    }
}

} // namespace

std::vector<std::uint16_t> bakedSides(const ShadowField& field, std::uint32_t side)
{
    std::vector<std::uint16_t> sides;
    for (std::size_t s = 0; s < field.shellSides.size(); ++s) {
        const float r = shellRadius(field, s);
        const bool coarser = side >= 65 && (r < 0.5f || r > 2);
        sides.push_back(static_cast<std::uint16_t>(coarser ? (side + 1) / 2 : side));
    }
    return sides;
}

BakeResult bakeMesh(const std::vector<vec3>& positions, const std::vector<vec3>& normals,
                    const std::vector<std::uint32_t>& indices, const BakeOptions& options,
                    Progress& progress)
{
    PENUMBRA_ASSERT(!positions.empty() && positions.size() == normals.size(),
                    "{} positions, {} normals", positions.size(), normals.size());
    PENUMBRA_ASSERT(options.shells >= 2 && options.side >= 3, "{} shells of side {}",
                    options.shells, options.side);

    const Sphere sphere = boundingSphere(positions, 64);
    PointSet vertices;
    for (const vec3& position : positions) {
        const vec3 p = (position - sphere.center) / sphere.radius;
        vertices.x.push_back(p.x);
        vertices.y.push_back(p.y);
        vertices.z.push_back(p.z);
    }

    BakeResult result;
    ShadowField& field = result.field.head;
    field.center = sphere.center;
    field.radius = sphere.radius;
    field.directions = options.directions;
    field.shellSides.assign(options.shells, 0);
    field.shellSides = bakedSides(field, options.side);

    Receivers surface =
        liftedVertices(vertices, normals, 2.0f / static_cast<float>(options.rasterSide));
    Receivers samples, offGrid;
    std::vector<std::uint32_t> node;
    if (options.field) {
        samples.points = shellNodes(field, node);
        samples.blocked.resize(node.size());
        ProbePoints drawn = drawProbes(field);
        result.probes = std::move(drawn.probes);
        offGrid.points = std::move(drawn.points);
        offGrid.blocked.resize(offGrid.points.points.size());
        offGrid.blockedByOdd.resize(offGrid.points.points.size());
    }

    const BakeDirections directions(options.directions);
    tbb::enumerable_thread_specific<RasterScratch> scratch;
    std::vector<LineSpace> lines(kBatch, LineSpace(options.rasterSide));
    progress.begin("bake", directions.pairs());
    for (std::size_t first = 0; first < directions.pairs(); first += kBatch) {
        const std::size_t count = std::min(kBatch, directions.pairs() - first);
        tbb::parallel_for(std::size_t{0}, count, [&](std::size_t b) {
            lines[b].rasterise(directions.directions[first + b], vertices, indices,
                               scratch.local());
        });
        accumulate(lines, directions, first, count, samples);
        accumulate(lines, directions, first, count, offGrid);
        accumulate(lines, directions, first, count, surface);
        progress.step(count);
    }

    for (const Sh4& blocked : surface.blocked)
        result.selfVisibility.push_back(quantiseSelfVisibility(blocked));
    result.field.nodes.resize(node.size());
    for (std::size_t i = 0; i < node.size(); ++i)
        for (std::size_t k = 0; k < 16; ++k)
            result.field.nodes[node[i]].c[k] = -samples.blocked[i].c[k];
    if (options.field)
        fillInside(result.field);
    readProbes(offGrid, result.probes);
    return result;
}

} // namespace penumbra
