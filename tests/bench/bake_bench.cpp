// bake/occlusion/TRIANGLES/VARIANT: an occlusion field as `assetc bake` makes it, 1,024 directions.
//   line_space     bakeMesh
//   embree_naive   one point at a time, its directions in packets of 16 as they come
//   embree_best    one direction at a time, 4 x 4 neighbouring nodes in a packet; rays that cannot
//                  meet the bounding sphere are not traced
// All for the same points: the nodes of the shells, the probes between them and the vertices.
#include "assetc/bake.h"
#include "assetc/bake/directions.h"
#include "assetc/embree_scene.h"
#include "assets/bounding_sphere.h"
#include "shaders/shared/field.h"
#include "tests/bench/bench_knot.h"

#include <benchmark/benchmark.h>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <tbb/parallel_for.h>

namespace penumbra {

namespace {

constexpr std::uint32_t kDirections = 1024;

struct Nodes {
    ShadowField head;
    std::vector<vec3> positions; // [shell][y][x], then probes and vertices
    std::size_t nodes = 0;       // of the shells
};

Nodes fieldNodes(const MeshAsset& mesh)
{
    Nodes out;
    const Sphere sphere = boundingSphere(mesh.positions, 64);
    out.head.center = sphere.center;
    out.head.radius = sphere.radius;
    out.head.shellSides.assign(BakeOptions{}.shells, 0);
    out.head.shellSides = bakedSides(out.head, BakeOptions{}.side);
    for (std::size_t s = 0; s < out.head.shellSides.size(); ++s) {
        const std::uint32_t side = out.head.shellSides[s];
        for (std::uint32_t i = 0; i < side * side; ++i) {
            const vec2 uv = vec2(static_cast<float>(i % side), static_cast<float>(i / side)) /
                            static_cast<float>(side - 1);
            out.positions.push_back(sphere.center + sphere.radius * shellRadius(out.head, s) *
                                                        octahedralDirection(uv));
        }
    }
    out.nodes = out.positions.size();
    const PointSet probes = drawProbes(out.head).points.points;
    for (std::size_t i = 0; i < probes.size(); ++i)
        out.positions.push_back(sphere.center +
                                sphere.radius * vec3(probes.x[i], probes.y[i], probes.z[i]));
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        out.positions.push_back(mesh.positions[i] + 1e-3f * sphere.radius * mesh.normals[i]);
    return out;
}

struct Packet {
    alignas(64) RTCRay16 rays{};
    alignas(64) std::array<int, 16> valid{};
    std::array<std::uint32_t, 16> tag{};
    std::size_t count = 0;

    void add(vec3 origin, vec3 direction, std::uint32_t t)
    {
        const std::size_t k = count++;
        valid[k] = -1;
        tag[k] = t;
        rays.org_x[k] = origin.x;
        rays.org_y[k] = origin.y;
        rays.org_z[k] = origin.z;
        rays.dir_x[k] = direction.x;
        rays.dir_y[k] = direction.y;
        rays.dir_z[k] = direction.z;
        rays.tnear[k] = 0;
        rays.tfar[k] = std::numeric_limits<float>::infinity();
        rays.mask[k] = ~0u;
    }
    // Calls blocked(tag) for each ray that is.
    template <class Blocked>
    void trace(RTCScene scene, bool coherent, Blocked blocked)
    {
        if (count == 0)
            return;
        for (std::size_t k = count; k < 16; ++k) {
            valid[k] = 0;
            rays.dir_x[k] = 1; // Embree 3.13 hangs on idle lanes without a direction
            rays.tfar[k] = -1;
        }
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        if (coherent)
            context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        rtcOccluded16(valid.data(), scene, &context, &rays);
        for (std::size_t k = 0; k < count; ++k)
            if (rays.tfar[k] < 0)
                blocked(tag[k]);
        count = 0;
    }
};

bool meetsSphere(const ShadowField& head, vec3 origin, vec3 direction)
{
    const vec3 p = origin - head.center;
    const float along = dot(p, direction);
    const float r2 = head.radius * head.radius, d2 = dot(p, p);
    return d2 <= r2 || (along < 0 && d2 - along * along <= r2);
}

std::vector<Sh4> bases(const std::vector<vec3>& directions)
{
    std::vector<Sh4> out;
    for (const vec3& direction : directions)
        out.push_back(shBasis(direction));
    return out;
}

void addTo(Sh4& sum, const Sh4& y)
{
    for (int k = 0; k < 16; ++k)
        sum.c[k] += y.c[k];
}

void traceNaive(const EmbreeScene& scene, const Nodes& nodes, std::vector<Sh4>& sums)
{
    const std::vector<vec3> directions = bakeDirections(kDirections);
    const std::vector<Sh4> basis = bases(directions);
    tbb::parallel_for(std::size_t{0}, nodes.positions.size(), [&](std::size_t i) {
        Packet packet;
        const auto flush = [&] {
            packet.trace(scene.handle(), false, [&](std::uint32_t d) { addTo(sums[i], basis[d]); });
        };
        for (std::uint32_t d = 0; d < kDirections; ++d) {
            packet.add(nodes.positions[i], directions[d], d);
            if (packet.count == 16)
                flush();
        }
        flush();
    });
}

void traceBest(const EmbreeScene& scene, const Nodes& nodes, std::vector<Sh4>& sums)
{
    const std::vector<vec3> directions = bakeDirections(kDirections);
    const std::vector<Sh4> basis = bases(directions);
    struct Tile {
        std::uint32_t first, side, x, y;
    };
    std::vector<Tile> tiles;
    std::uint32_t first = 0;
    for (const std::uint32_t side : nodes.head.shellSides) {
        for (std::uint32_t y = 0; y < side; y += 4)
            for (std::uint32_t x = 0; x < side; x += 4)
                tiles.push_back({first, side, x, y});
        first += side * side;
    }
    const std::size_t others = (nodes.positions.size() - nodes.nodes + 15) / 16;
    tbb::parallel_for(std::size_t{0}, others, [&](std::size_t group) {
        const std::size_t begin = nodes.nodes + 16 * group;
        const std::size_t end = std::min(begin + 16, nodes.positions.size());
        Packet packet;
        for (std::uint32_t d = 0; d < kDirections; ++d) {
            for (std::size_t i = begin; i < end; ++i)
                if (meetsSphere(nodes.head, nodes.positions[i], directions[d]))
                    packet.add(nodes.positions[i], directions[d], static_cast<std::uint32_t>(i));
            packet.trace(scene.handle(), true, [&](std::uint32_t i) { addTo(sums[i], basis[d]); });
        }
    });
    tbb::parallel_for(std::size_t{0}, tiles.size(), [&](std::size_t t) {
        const Tile tile = tiles[t];
        Packet packet;
        for (std::uint32_t d = 0; d < kDirections; ++d) {
            for (std::uint32_t y = tile.y; y < std::min(tile.y + 4, tile.side); ++y)
                for (std::uint32_t x = tile.x; x < std::min(tile.x + 4, tile.side); ++x) {
                    const std::uint32_t node = tile.first + y * tile.side + x;
                    if (meetsSphere(nodes.head, nodes.positions[node], directions[d]))
                        packet.add(nodes.positions[node], directions[d], node);
                }
            packet.trace(scene.handle(), true,
                         [&](std::uint32_t node) { addTo(sums[node], basis[d]); });
        }
    });
}

void lineSpace(benchmark::State& state, const MeshAsset& mesh)
{
    BakeOptions options;
    options.directions = kDirections;
    for (auto _ : state) {
        Progress progress("bench");
        benchmark::DoNotOptimize(
            bakeMesh(mesh.positions, mesh.normals, mesh.indices, options, progress));
    }
}

template <class Trace>
void embree(benchmark::State& state, const MeshAsset& mesh, Trace trace)
{
    const Nodes nodes = fieldNodes(mesh);
    const EmbreeScene scene(mesh.positions, mesh.indices);
    for (auto _ : state) {
        std::vector<Sh4> sums(nodes.positions.size());
        trace(scene, nodes, sums);
        benchmark::DoNotOptimize(sums);
    }
}

const int kRegistered = [] {
    for (const std::size_t triangles : {5'000, 20'000, 80'000, 320'000, 500'000}) {
        const auto add = [&](const char* variant, auto run) {
            benchmark::RegisterBenchmark(
                fmt::format("bake/occlusion/{}/{}", triangles, variant).c_str(),
                [triangles, run](benchmark::State& state) {
                    const MeshAsset mesh = torusKnot(triangles);
                    state.counters["triangles"] = static_cast<double>(mesh.indices.size() / 3);
                    run(state, mesh);
                })
                ->Unit(benchmark::kMillisecond)
                ->UseRealTime();
        };
        add("line_space", lineSpace);
        if (triangles != 20'000)
            continue;
        add("embree_naive", [](benchmark::State& state, const MeshAsset& mesh) {
            embree(state, mesh, traceNaive);
        });
        add("embree_best",
            [](benchmark::State& state, const MeshAsset& mesh) { embree(state, mesh, traceBest); });
    }
    return 0;
}();

} // namespace

} // namespace penumbra
