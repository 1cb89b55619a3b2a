// bakeMesh: samples of all shells and all vertices, looked up in the same line spaces
// (assetc/bake/line_space.h).
#include "assetc/bake.h"

#include "assetc/bake/directions.h"
#include "assetc/bake/fill_inside.h"
#include "assetc/bake/inscribed_sphere.h"
#include "assetc/bake/point_blocks.h"
#include "assetc/bake/target_clones.h"
#include "assetc/embree_scene.h"
#include "assetc/trace_visibility.h"
#include "assets/bounding_sphere.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <glm/gtc/constants.hpp>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

namespace penumbra {

namespace {

// Direction pairs rasterised before looking up: their lines, 0.8 MB each, stay in the caches.
constexpr std::size_t kBatch = 4; // even: see accumulate

// Of a raster's pixel: so close to the surface lie one node in a hundred and two thirds of the
// squared error.
constexpr float kTracedWithin = 0.2f;
constexpr float kSeesLittle = 0.9f; // of all directions are blocked

struct BakeDirections {
    std::vector<vec3> directions; // antipodal halves
    std::vector<Sh4> basis;       // times the solid angle of a direction
    float cellHalfWidth = 0;      // of the square with the solid angle of a direction

    explicit BakeDirections(std::uint32_t count) : directions(bakeDirections(count))
    {
        const float weight = 4 * glm::pi<float>() / static_cast<float>(directions.size());
        for (const vec3& d : directions) {
            basis.push_back(shBasis(d));
            for (float& c : basis.back().c)
                c *= weight;
        }
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

// Directions of one batch in which some point of a block is blocked.
struct BlockedDirections {
    std::size_t count = 0;
    const float* parts[2 * kBatch]; // [points]
    Sh4 basis[2 * kBatch];          // times the solid angle of a direction
};

// Adding nothing for a point that is free costs less than asking whether it is.
PENUMBRA_CLONES void addBlocked(const BlockedDirections& blocked, std::size_t points, Sh4* sums)
{
    using Lanes = float __attribute__((vector_size(64))); // all coefficients
    for (std::size_t p = 0; p < points; ++p) {
        Lanes sum;
        std::memcpy(&sum, sums[p].c, sizeof(Lanes));
        for (std::size_t b = 0; b < blocked.count; ++b) {
            Lanes basis;
            std::memcpy(&basis, blocked.basis[b].c, sizeof(Lanes));
            sum += blocked.parts[b][p] * basis;
        }
        std::memcpy(sums[p].c, &sum, sizeof(Lanes));
    }
}

// Half of the directions lie below a vertex' tangent plane.
void clearBelow(const std::vector<vec3>& normals, std::size_t begin, std::size_t count, vec3 w,
                LineSpace::BlockedParts& parts)
{
    for (std::size_t p = 0; p < count; ++p) {
        const bool above = dot(normals[begin + p], w) > 0;
        parts[0][p] = above ? parts[0][p] : 0.0f;
        parts[1][p] = above ? 0.0f : parts[1][p];
    }
}

// The order of additions depends on nothing but the point, so any thread count gives the same bits.
void accumulate(const std::vector<LineSpace>& lines, const BakeDirections& bake,
                std::size_t firstPair, std::size_t pairs, Receivers& receivers)
{
    tbb::parallel_for(std::size_t{0}, receivers.points.blocks.size(), [&](std::size_t i) {
        const PointBlock& block = receivers.points.blocks[i];
        const float cell = block.nearest > kCellRadius ? bake.cellHalfWidth : 0;
        const std::size_t sets = receivers.blockedByOdd.empty() ? 1 : 2;
        for (std::size_t set = 0; set < sets; ++set) {
            LineSpace::BlockedParts parts[kBatch];
            BlockedDirections blocked;
            for (std::size_t b = set; b < pairs; b += sets) {
                const std::size_t plus = firstPair + b; // a batch begins with an even one
                const vec3 w = bake.directions[plus];
                if (!mayMeetUnitSphere(block, w, cell))
                    continue;
                const unsigned any = lines[b].lookUp(receivers.points.points, block.begin,
                                                     block.count, cell, parts[b]);
                if (any != 0 && !receivers.normals.empty())
                    clearBelow(receivers.normals, block.begin, block.count, w, parts[b]);
                for (const std::size_t sign : {0, 1}) {
                    if ((any >> sign & 1) == 0)
                        continue;
                    blocked.parts[blocked.count] = parts[b][sign];
                    blocked.basis[blocked.count++] = bake.basis[plus + sign * bake.pairs()];
                }
            }
            std::vector<Sh4>& sums = set == 1 ? receivers.blockedByOdd : receivers.blocked;
            addBlocked(blocked, block.count, sums.data() + block.begin);
        }
    });
}

// Replaces what the rasters say of points beside the surface: up to a part of a pixel from it they
// take a point for one on the other side in many directions. And of points that see next to
// nothing: most lie inside, where a line at a rim lets a few directions out.
void traceBeside(const EmbreeScene& scene, const ShadowField& field, const BakeDirections& bake,
                 float pixel, Receivers& receivers)
{
    const PointSet& p = receivers.points.points;
    const float within = kTracedWithin * pixel;
    const std::size_t sets = receivers.blockedByOdd.empty() ? 1 : 2;
    std::vector<vec3> directions[2];
    std::vector<Sh4> basis[2];
    for (std::size_t d = 0; d < bake.directions.size(); ++d) {
        const std::size_t set = d % bake.pairs() % sets;
        directions[set].push_back(bake.directions[d]);
        basis[set].push_back(bake.basis[d]);
    }
    tbb::parallel_for(std::size_t{0}, p.size(), [&](std::size_t i) {
        const vec3 point(p.x[i], p.y[i], p.z[i]), at = field.center + field.radius * point;
        const float reach = field.radius * within;
        const float blocked =
            receivers.blocked[i].c[0] + (sets == 2 ? receivers.blockedByOdd[i].c[0] : 0);
        const bool seesLittle = blocked > kSeesLittle * kSqrt4Pi && blocked < -kSeesNothing;
        // Beside a surface about half of the directions are blocked, at needle tips fewer.
        const bool mayTouch = length(point) < 1 + within && blocked > 0.1f * kSqrt4Pi;
        if (!mayTouch || (!seesLittle && scene.distance(at, reach) >= reach))
            return;
        receivers.blocked[i] = traceBlocked(scene.handle(), at, directions[0], basis[0]);
        if (sets == 2)
            receivers.blockedByOdd[i] = traceBlocked(scene.handle(), at, directions[1], basis[1]);
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

std::uint32_t rasterSideFor(std::uint32_t directions)
{
    const auto side = static_cast<std::uint32_t>(10 * std::sqrt(static_cast<float>(directions)));
    return std::clamp(side / 8 * 8, 320u, 1024u);
}

Result<void> checkExtent(const MeshAsset& mesh)
{
    const float size = length(mesh.boundsMax - mesh.boundsMin);
    if (size > 4 * kMinFieldRadius && size < kMaxCoordinate) // its bounding sphere has a field
        return {};
    return Error{fmt::format("{} m across, allowed {} to {} m; scale it, its unit is the metre",
                             size, 4 * kMinFieldRadius, kMaxCoordinate)};
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

    const std::uint32_t rasterSide =
        options.rasterSide > 0 ? options.rasterSide : rasterSideFor(options.directions);
    const float pixel = 2.0f / static_cast<float>(rasterSide); // bounding radii
    Receivers surface = liftedVertices(vertices, normals, pixel);
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
    const TriangleSet triangles(indices);
    tbb::enumerable_thread_specific<RasterScratch> scratch;
    std::vector<LineSpace> lines(kBatch, LineSpace(rasterSide));
    progress.begin("bake", directions.pairs());
    for (std::size_t first = 0; first < directions.pairs(); first += kBatch) {
        const std::size_t count = std::min(kBatch, directions.pairs() - first);
        tbb::parallel_for(std::size_t{0}, count, [&](std::size_t b) {
            lines[b].rasterise(directions.directions[first + b], vertices, triangles,
                               scratch.local());
        });
        accumulate(lines, directions, first, count, samples);
        accumulate(lines, directions, first, count, offGrid);
        accumulate(lines, directions, first, count, surface);
        progress.step(count);
    }
    for (const Sh4& blocked : surface.blocked)
        result.selfVisibility.push_back(quantiseSelfVisibility(blocked));
    if (!options.field)
        return result;

    const EmbreeScene scene(positions, indices);
    traceBeside(scene, field, directions, pixel, samples);
    traceBeside(scene, field, directions, pixel, offGrid);
    result.field.nodes.resize(node.size());
    for (std::size_t i = 0; i < node.size(); ++i)
        for (std::size_t k = 0; k < 16; ++k)
            result.field.nodes[node[i]].c[k] = -samples.blocked[i].c[k];
    fillInside(result.field);
    field.inscribed = inscribedSphere(scene, result.field, directions.directions, directions.basis);
    readProbes(offGrid, result.probes);
    return result;
}

} // namespace penumbra
