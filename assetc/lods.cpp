#include "assetc/lods.h"

#include "assetc/embree_scene.h"
#include "assetc/order.h"

#include <algorithm>
#include <meshoptimizer.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

namespace penumbra {

namespace {

constexpr float kStalled = 0.85f; // of the triangles of the level before: not worth a level

// `indices` of vertices of `full` as a geometry of its own, submesh by submesh. A triangle belongs
// to the submesh of its first corner.
MeshLod makeLevel(const MeshGeometry& full, const std::vector<std::uint32_t>& indices)
{
    MeshLod lod;
    std::vector<std::uint32_t> sources;
    std::vector<std::uint32_t> placeOf(full.positions.size());
    for (const Submesh& part : submeshesOf(full)) {
        const auto firstVertex = static_cast<std::uint32_t>(sources.size());
        const auto firstIndex = static_cast<std::uint32_t>(lod.indices.size());
        std::fill(placeOf.begin(), placeOf.end(), ~0u);
        for (std::size_t t = 0; t < indices.size(); t += 3) {
            if (indices[t] < part.firstVertex || indices[t] >= part.firstVertex + part.vertexCount)
                continue;
            for (std::size_t corner = t; corner < t + 3; ++corner) {
                std::uint32_t& place = placeOf[indices[corner]];
                if (place == ~0u) {
                    place = static_cast<std::uint32_t>(sources.size());
                    sources.push_back(indices[corner]);
                }
                lod.indices.push_back(place);
            }
        }
        if (lod.indices.size() > firstIndex)
            lod.submeshes.push_back(
                {firstIndex, static_cast<std::uint32_t>(lod.indices.size()) - firstIndex,
                 firstVertex, static_cast<std::uint32_t>(sources.size()) - firstVertex,
                 part.material});
    }
    std::vector<std::uint32_t> kept = std::move(lod.indices);
    std::vector<Submesh> submeshes = std::move(lod.submeshes);
    static_cast<MeshGeometry&>(lod) = full;
    gatherVertices(lod, sources);
    lod.indices = std::move(kept);
    lod.submeshes = std::move(submeshes);
    return lod;
}

// The largest distance of the mesh's vertices from the level, at most `limit`: meshoptimizer's own
// estimate knows nothing of parts that go whole.
float distanceFrom(const MeshGeometry& level, const MeshGeometry& mesh, float limit)
{
    constexpr std::size_t kSamples = std::size_t{1} << 16;
    const std::size_t step = mesh.positions.size() / kSamples + 1;
    const EmbreeScene scene(level.positions, level.indices);
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, mesh.positions.size() / step), 0.0f,
        [&](const tbb::blocked_range<std::size_t>& range, float largest) {
            for (std::size_t i = range.begin(); i < range.end(); ++i)
                largest = std::max(largest, scene.distance(mesh.positions[i * step], limit));
            return largest;
        },
        [](float a, float b) { return std::max(a, b); });
}

} // namespace

void buildLods(MeshAsset& mesh, std::uint32_t count)
{
    mesh.lods.clear();
    const float* positions = &mesh.positions[0].x;
    const float scale = meshopt_simplifyScale(positions, mesh.positions.size(), sizeof(vec3));
    std::size_t previous = mesh.indices.size();
    for (std::uint32_t level = 1; level <= std::min(count, kMaxMeshLods); ++level) {
        std::vector<std::uint32_t> indices(mesh.indices.size());
        const std::size_t target = (mesh.indices.size() / 3 >> level) * 3;
        float error = 0;
        indices.resize(meshopt_simplify(indices.data(), mesh.indices.data(), mesh.indices.size(),
                                        positions, mesh.positions.size(), sizeof(vec3), target,
                                        kMaxLodError, 0u, &error));
        if (indices.empty() ||
            static_cast<float>(indices.size()) > kStalled * static_cast<float>(previous))
            break;
        previous = indices.size();
        MeshLod lod = makeLevel(mesh, indices);
        lod.error = std::max(error * scale, distanceFrom(lod, mesh, kMaxLodError * scale));
        if (!(lod.error < kMaxLodError * scale))
            break;
        orderClusters(lod);
        mesh.lods.push_back(std::move(lod));
    }
    updateDerived(mesh);
}

} // namespace penumbra
