#include "assets/mesh_asset.h"

#include "assets/bounding_sphere.h"

#include <algorithm>
#include <map>
#include <span>

namespace penumbra {

namespace {

NormalCone boundNormals(std::span<const vec3> normals)
{
    vec3 sum{0};
    for (const vec3 normal : normals)
        sum += normal;
    const float size = length(sum);
    if (size <= 1e-3f * static_cast<float>(normals.size()) || !(size > 0))
        return {};
    NormalCone cone{sum / size, 1};
    for (const vec3 normal : normals)
        cone.cutoff = std::min(cone.cutoff, dot(normal, cone.axis));
    cone.cutoff = std::max(cone.cutoff - 1e-5f, -1.0f);
    return cone;
}

} // namespace

std::vector<MeshCluster> buildClusters(const std::vector<vec3>& positions,
                                       const std::vector<vec3>& normals,
                                       const std::vector<std::uint32_t>& indices)
{
    PENUMBRA_ASSERT(normals.size() == positions.size(), "{} normals of {} positions",
                    normals.size(), positions.size());
    const std::size_t clusterCount = (positions.size() + kClusterVertices - 1) / kClusterVertices;
    // Triangles by cluster: counted, then filled. A triangle enters each cluster that it touches
    // once.
    const auto visit = [&](auto&& enter) {
        for (std::uint32_t corner = 0; corner + 2 < indices.size(); corner += 3) {
            const std::uint32_t a = indices[corner] / kClusterVertices;
            const std::uint32_t b = indices[corner + 1] / kClusterVertices;
            const std::uint32_t c = indices[corner + 2] / kClusterVertices;
            PENUMBRA_DEBUG_ASSERT(std::max({a, b, c}) < clusterCount, "triangle {} of {} vertices",
                                  corner / 3, positions.size());
            enter(a, corner);
            if (b != a)
                enter(b, corner);
            if (c != a && c != b)
                enter(c, corner);
        }
    };
    std::vector<std::uint32_t> begins(clusterCount + 1, 0);
    visit([&](std::uint32_t cluster, std::uint32_t) { ++begins[cluster + 1]; });
    for (std::size_t i = 0; i < clusterCount; ++i)
        begins[i + 1] += begins[i];
    std::vector<std::uint32_t> corners(begins.back());
    std::vector<std::uint32_t> ends(begins.begin(), begins.end() - 1);
    visit([&](std::uint32_t cluster, std::uint32_t corner) { corners[ends[cluster]++] = corner; });

    std::vector<MeshCluster> clusters(clusterCount);
    std::vector<vec3> points;
    std::vector<vec3> faceNormals;
    for (std::size_t i = 0; i < clusterCount; ++i) {
        const std::size_t first = i * kClusterVertices;
        const std::size_t count = std::min<std::size_t>(kClusterVertices, positions.size() - first);
        const auto own = std::span(positions).subspan(first, count);
        points.assign(own.begin(), own.end());
        faceNormals.clear();
        for (std::uint32_t t = begins[i]; t < begins[i + 1]; ++t) {
            const vec3 a = positions[indices[corners[t]]];
            const vec3 b = positions[indices[corners[t] + 1]];
            const vec3 c = positions[indices[corners[t] + 2]];
            points.insert(points.end(), {a, b, c});
            const vec3 normal = cross(b - a, c - a);
            if (const float size = length(normal); size > 0)
                faceNormals.push_back(normal / size);
        }
        const Sphere sphere = boundingSphere(points, 16);
        clusters[i] = {sphere.center, sphere.radius, boundNormals(faceNormals),
                       boundNormals(std::span(normals).subspan(first, count))};
    }
    return clusters;
}

std::vector<Submesh> submeshesOf(const MeshGeometry& geometry)
{
    if (!geometry.submeshes.empty())
        return geometry.submeshes;
    return {{0, static_cast<std::uint32_t>(geometry.indices.size()), 0,
             static_cast<std::uint32_t>(geometry.positions.size()), 0}};
}

void gatherVertices(MeshGeometry& geometry, const std::vector<std::uint32_t>& from)
{
    forEachVertexArray(geometry, [&](auto& array) {
        if (array.empty())
            return;
        const auto old = std::move(array);
        array.clear();
        array.reserve(from.size());
        for (const std::uint32_t vertex : from)
            array.push_back(old[vertex]);
    });
}

std::uint32_t largestMaterial(const MeshGeometry& geometry)
{
    std::map<std::uint32_t, double> areas;
    for (const Submesh& part : submeshesOf(geometry))
        for (std::uint32_t i = part.firstIndex; i + 2 < part.firstIndex + part.indexCount; i += 3) {
            const glm::dvec3 a(geometry.positions[geometry.indices[i]]);
            const glm::dvec3 b(geometry.positions[geometry.indices[i + 1]]);
            const glm::dvec3 c(geometry.positions[geometry.indices[i + 2]]);
            areas[part.material] += glm::length(glm::cross(b - a, c - a));
        }
    const auto largest =
        std::max_element(areas.begin(), areas.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    return largest == areas.end() ? 0 : largest->first;
}

void updateDerived(MeshAsset& mesh)
{
    mesh.clusters = buildClusters(mesh.positions, mesh.normals, mesh.indices);
    for (MeshLod& lod : mesh.lods)
        lod.clusters = buildClusters(lod.positions, lod.normals, lod.indices);
    if (!mesh.materials.empty())
        mesh.material = mesh.materials[largestMaterial(mesh)];
    mesh.boundsMin = mesh.boundsMax = mesh.positions.empty() ? vec3{0} : mesh.positions.front();
    for (const vec3 position : mesh.positions) {
        mesh.boundsMin = glm::min(mesh.boundsMin, position);
        mesh.boundsMax = glm::max(mesh.boundsMax, position);
    }
}

} // namespace penumbra
