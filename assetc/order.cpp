#include "assetc/order.h"

#include <algorithm>
#include <meshoptimizer.h>
#include <numeric>

namespace penumbra {

namespace {

constexpr float kConeWeight = 0.5f; // of meshlets: the middle between small and flat
// Unit normals against positions in bounding radii, in the median split. On bunny, suzi, boot and
// wingnut 0 leaves 45 % of the clusters without a cone, 0.2 leaves 16 % for 20 % more radius;
// above, spheres grow faster than cones shrink.
constexpr float kNormalWeight = 0.2f;

using Key = std::array<float, 6>;

// Sorts places [begin, end), which need not begin with a cluster.
void splitRange(std::vector<std::uint32_t>& order, const std::vector<Key>& keys, std::size_t begin,
                std::size_t end)
{
    const std::size_t firstCluster = begin / kClusterVertices;
    const std::size_t clusters = (end + kClusterVertices - 1) / kClusterVertices - firstCluster;
    if (begin == end || clusters < 2)
        return;
    Key low = keys[order[begin]];
    Key high = low;
    for (std::size_t i = begin; i < end; ++i)
        for (std::size_t k = 0; k < low.size(); ++k) {
            low[k] = std::min(low[k], keys[order[i]][k]);
            high[k] = std::max(high[k], keys[order[i]][k]);
        }
    std::size_t axis = 0;
    for (std::size_t k = 1; k < low.size(); ++k)
        if (high[k] - low[k] > high[axis] - low[axis])
            axis = k;
    const std::size_t middle = (firstCluster + clusters / 2) * kClusterVertices;
    const auto at = [&](std::size_t i) { return order.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
        return keys[a][axis] != keys[b][axis] ? keys[a][axis] < keys[b][axis] : a < b;
    });
    splitRange(order, keys, begin, middle);
    splitRange(order, keys, middle, end);
}

// Indices of a submesh, counted from its first vertex.
std::vector<std::uint32_t> localIndices(const MeshGeometry& mesh, const Submesh& part)
{
    std::vector<std::uint32_t> indices(mesh.indices.begin() + part.firstIndex,
                                       mesh.indices.begin() + part.firstIndex + part.indexCount);
    for (std::uint32_t& index : indices)
        index -= part.firstVertex;
    return indices;
}

} // namespace

ClusterQuality measureClusters(const MeshGeometry& mesh)
{
    vec3 low = mesh.positions.front();
    vec3 high = low;
    for (const vec3 p : mesh.positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const float bounding = 0.5f * length(high - low);
    const std::vector<MeshCluster> clusters =
        buildClusters(mesh.positions, mesh.normals, mesh.indices);
    double radius = 0;
    double cutoff = 0;
    double coneless = 0;
    for (const MeshCluster& cluster : clusters) {
        radius += cluster.radius / bounding;
        cutoff += cluster.faces.cutoff;
        coneless += cluster.faces.cutoff <= 0 ? 1 : 0;
    }
    const auto count = static_cast<double>(clusters.size());
    ClusterQuality quality;
    quality.meanRadius = static_cast<float>(radius / count);
    quality.meanCutoff = static_cast<float>(cutoff / count);
    quality.conelessPart = static_cast<float>(coneless / count);
    // Far occluders are interpolated over a cluster's radius and backfaces culled by its cone: both
    // count.
    quality.cost = quality.meanRadius * (1.5f - 0.5f * quality.meanCutoff);
    return quality;
}

std::vector<std::uint32_t> orderByMeshlets(const MeshGeometry& mesh)
{
    constexpr std::size_t kMaxTriangles =
        124; // a multiple of 4, as meshoptimizer asks, about twice the vertices
    std::vector<std::uint32_t> order;
    std::vector<bool> placed(mesh.positions.size(), false);
    for (const Submesh& part : submeshesOf(mesh)) {
        const std::size_t bound =
            meshopt_buildMeshletsBound(part.indexCount, kClusterVertices, kMaxTriangles);
        std::vector<meshopt_Meshlet> meshlets(bound);
        std::vector<unsigned> vertices(bound * kClusterVertices);
        std::vector<unsigned char> corners(bound * kMaxTriangles * 3);
        const std::vector<std::uint32_t> indices = localIndices(mesh, part);
        meshlets.resize(meshopt_buildMeshlets(
            meshlets.data(), vertices.data(), corners.data(), indices.data(), indices.size(),
            &mesh.positions[part.firstVertex].x, part.vertexCount, sizeof(vec3), kClusterVertices,
            kMaxTriangles, kConeWeight));
        for (const meshopt_Meshlet& meshlet : meshlets)
            for (unsigned i = 0; i < meshlet.vertex_count; ++i) {
                const unsigned vertex = part.firstVertex + vertices[meshlet.vertex_offset + i];
                if (!placed[vertex])
                    order.push_back(vertex);
                placed[vertex] = true;
            }
    }
    PENUMBRA_ASSERT(order.size() == mesh.positions.size(),
                    "{} of {} vertices used: the mesh is not clean", order.size(),
                    mesh.positions.size());
    return order;
}

std::vector<std::uint32_t> orderByMedianSplit(const MeshGeometry& mesh)
{
    vec3 low = mesh.positions.front();
    vec3 high = low;
    for (const vec3 p : mesh.positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const float scale = 2 / length(high - low);
    std::vector<Key> keys;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const vec3 p = (mesh.positions[i] - low) * scale;
        const vec3 n = mesh.normals[i] * kNormalWeight;
        keys.push_back({p.x, p.y, p.z, n.x, n.y, n.z});
    }
    std::vector<std::uint32_t> order(mesh.positions.size());
    std::iota(order.begin(), order.end(), 0u);
    for (const Submesh& part : submeshesOf(mesh))
        splitRange(order, keys, part.firstVertex, std::size_t{part.firstVertex} + part.vertexCount);
    return order;
}

void applyOrder(MeshGeometry& mesh, const std::vector<std::uint32_t>& order)
{
    std::vector<std::uint32_t> placeOf(order.size());
    for (std::uint32_t i = 0; i < order.size(); ++i)
        placeOf[order[i]] = i;
    gatherVertices(mesh, order);
    for (std::uint32_t& index : mesh.indices)
        index = placeOf[index];
}

OrderReport orderClusters(MeshGeometry& mesh)
{
    MeshGeometry split = mesh;
    applyOrder(split, orderByMedianSplit(mesh));
    applyOrder(mesh, orderByMeshlets(mesh));
    OrderReport report{"meshlets", measureClusters(mesh)};
    if (const ClusterQuality quality = measureClusters(split); quality.cost < report.quality.cost) {
        report = {"median split", quality};
        mesh = std::move(split);
    }
    for (const Submesh& part : submeshesOf(mesh)) {
        const std::vector<std::uint32_t> old = localIndices(mesh, part);
        std::vector<std::uint32_t> indices(old.size());
        meshopt_optimizeVertexCache(indices.data(), old.data(), old.size(), part.vertexCount);
        for (std::size_t i = 0; i < indices.size(); ++i)
            mesh.indices[part.firstIndex + i] = part.firstVertex + indices[i];
    }
    return report;
}

} // namespace penumbra
