#include "assets/mesh_asset.h"

#include "assets/bounding_sphere.h"

#include <algorithm>
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

void updateDerived(MeshAsset& mesh)
{
    mesh.clusters = buildClusters(mesh.positions, mesh.normals, mesh.indices);
    mesh.boundsMin = mesh.boundsMax = mesh.positions.empty() ? vec3{0} : mesh.positions.front();
    for (const vec3 position : mesh.positions) {
        mesh.boundsMin = glm::min(mesh.boundsMin, position);
        mesh.boundsMax = glm::max(mesh.boundsMax, position);
    }
}

Result<void> validateMesh(const MeshAsset& mesh)
{
    const std::size_t vertexCount = mesh.positions.size();
    if (vertexCount == 0 || mesh.indices.empty())
        return Error{"mesh: no triangles"};
    if (vertexCount > kMaxMeshVertices || mesh.indices.size() / 3 > kMaxMeshTriangles)
        return Error{
            fmt::format("mesh: {} vertices and {} triangles, above the limits of {} and {}",
                        vertexCount, mesh.indices.size() / 3, kMaxMeshVertices, kMaxMeshTriangles)};
    if (mesh.indices.size() % 3 != 0)
        return Error{fmt::format("mesh: {} indices are not whole triangles", mesh.indices.size())};
    if (mesh.normals.size() != vertexCount || mesh.selfVisibility.size() != vertexCount)
        return Error{fmt::format("mesh: {} positions, {} normals, {} self-visibilities",
                                 vertexCount, mesh.normals.size(), mesh.selfVisibility.size())};
    for (std::size_t i = 0; i < mesh.indices.size(); ++i)
        if (mesh.indices[i] >= vertexCount)
            return Error{fmt::format("mesh: triangle {} uses vertex {} of {}", i / 3,
                                     mesh.indices[i], vertexCount)};
    for (std::size_t i = 0; i < vertexCount; ++i) {
        const vec3 p = abs(mesh.positions[i]);
        if (!(p.x <= kMaxCoordinate && p.y <= kMaxCoordinate && p.z <= kMaxCoordinate))
            return Error{fmt::format("mesh: vertex {}: a coordinate beyond {} m or not finite", i,
                                     kMaxCoordinate)};
        const float squared = dot(mesh.normals[i], mesh.normals[i]);
        if (!(squared > 0.98f && squared < 1.02f))
            return Error{
                fmt::format("mesh: vertex {}: normal of length {}", i, std::sqrt(squared))};
    }
    const MeshMaterial& material = mesh.material;
    for (int channel = 0; channel < 3; ++channel)
        if (!(material.albedo[channel] >= 0 && material.albedo[channel] <= 1))
            return Error{
                fmt::format("material: albedo {}, allowed 0 to 1", material.albedo[channel])};
    if (!(material.glossFraction >= 0 && material.glossFraction <= 1))
        return Error{
            fmt::format("material: gloss fraction {}, allowed 0 to 1", material.glossFraction)};
    if (!(material.glossExponent >= 0 && material.glossExponent <= kMaxGlossExponent))
        return Error{fmt::format("material: gloss exponent {}, allowed 0 to {}",
                                 material.glossExponent, kMaxGlossExponent)};
    if (mesh.name.size() > kMaxNameBytes)
        return Error{
            fmt::format("mesh: name of {} bytes, at most {}", mesh.name.size(), kMaxNameBytes)};
    return mesh.field ? validateField(*mesh.field) : Result<void>{};
}

} // namespace penumbra
