#include "assetc/import/clean.h"

#include "assetc/import/compact.h"
#include "assetc/import/normals.h"
#include "assetc/import/vertex_key.h"

#include <algorithm>
#include <numeric>
#include <unordered_map>

namespace penumbra {

namespace {

bool hasArea(vec3 a, vec3 b, vec3 c)
{
    // In double: the square of a thin triangle's area must not vanish.
    const glm::dvec3 normal =
        glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
    return glm::dot(normal, normal) > 0;
}

// Keeps the triangles with an area; `materialOf` [triangleCount] becomes theirs.
std::size_t dropDegenerate(MeshAsset& mesh, std::vector<std::uint32_t>& materialOf)
{
    std::size_t kept = 0;
    for (const Submesh& part : submeshesOf(mesh))
        for (std::size_t t = part.firstIndex; t + 2 < part.firstIndex + part.indexCount; t += 3) {
            const std::uint32_t a = mesh.indices[t];
            const std::uint32_t b = mesh.indices[t + 1];
            const std::uint32_t c = mesh.indices[t + 2];
            if (!hasArea(mesh.positions[a], mesh.positions[b], mesh.positions[c]))
                continue;
            mesh.indices[kept++] = a;
            mesh.indices[kept++] = b;
            mesh.indices[kept++] = c;
            materialOf.push_back(part.material);
        }
    const std::size_t dropped = (mesh.indices.size() - kept) / 3;
    mesh.indices.resize(kept);
    return dropped;
}

// Triangles of one material together, otherwise in their order.
void groupByMaterial(std::vector<std::uint32_t>& indices, std::vector<std::uint32_t>& materialOf)
{
    std::vector<std::uint32_t> order(materialOf.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return materialOf[a] < materialOf[b];
    });
    const std::vector<std::uint32_t> old = std::move(indices);
    indices.clear();
    for (const std::uint32_t triangle : order)
        indices.insert(indices.end(), &old[std::size_t{3} * triangle],
                       &old[std::size_t{3} * triangle] + 3);
    std::sort(materialOf.begin(), materialOf.end());
}

// All that tells vertices apart: position, normal, texture coordinates, colour, material.
using VertexKey = FloatKey<12>;

VertexKey keyOf(const MeshAsset& mesh, std::uint32_t vertex, vec3 normal, std::uint32_t material)
{
    const vec3 p = mesh.positions[vertex];
    const vec2 uv0 = mesh.texcoords0.empty() ? vec2{0} : mesh.texcoords0[vertex];
    const vec2 uv1 = mesh.texcoords1.empty() ? vec2{0} : mesh.texcoords1[vertex];
    const VertexColor color = mesh.colors.empty() ? VertexColor{} : mesh.colors[vertex];
    return {{keyBits(p.x), keyBits(p.y), keyBits(p.z), keyBits(normal.x), keyBits(normal.y),
             keyBits(normal.z), keyBits(uv0.x), keyBits(uv0.y), keyBits(uv1.x), keyBits(uv1.y),
             std::bit_cast<std::uint32_t>(color), material}};
}

// One vertex per distinct key, in order of first use, and the submeshes of that.
void mergeVertices(MeshAsset& mesh, const std::vector<std::uint32_t>& materialOf,
                   CleanReport& report)
{
    const std::vector<vec3> normals = cornerNormals(mesh);
    std::unordered_map<VertexKey, std::uint32_t, FloatKeyHash<12>> vertexOf;
    std::vector<std::uint32_t> sources; // [vertexCount] vertex of the file
    std::vector<vec3> sourceNormals;    // [vertexCount]
    mesh.submeshes.clear();
    for (std::uint32_t corner = 0; corner < mesh.indices.size(); ++corner) {
        const std::uint32_t material = materialOf[corner / 3];
        const std::uint32_t source = mesh.indices[corner];
        const auto place = static_cast<std::uint32_t>(sources.size());
        if (mesh.submeshes.empty() || mesh.submeshes.back().material != material)
            mesh.submeshes.push_back({corner, 0, place, 0, material});
        const auto [found, isNew] =
            vertexOf.emplace(keyOf(mesh, source, normals[corner], material), place);
        if (isNew) {
            sources.push_back(source);
            sourceNormals.push_back(normals[corner]);
            report.generatedNormals += mesh.normals[source] == vec3{0} ? 1 : 0;
            ++mesh.submeshes.back().vertexCount;
        }
        ++mesh.submeshes.back().indexCount;
        mesh.indices[corner] = found->second;
    }
    report.mergedVertices = mesh.positions.size() - std::min(mesh.positions.size(), sources.size());
    gatherVertices(mesh, sources);
    mesh.normals = std::move(sourceNormals);
    for (vec3& position : mesh.positions)
        position += 0.0f; // -0 becomes 0
}

Result<void> checkPositions(const MeshAsset& mesh)
{
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            if (!(std::abs(mesh.positions[i][axis]) <= kMaxCoordinate))
                return Error{fmt::format("vertex {}: coordinate {} is not finite or beyond {} m", i,
                                         mesh.positions[i][axis], kMaxCoordinate)};
    return {};
}

} // namespace

Result<CleanReport> cleanMesh(MeshAsset& mesh)
{
    if (const auto checked = checkPositions(mesh); !checked)
        return checked.error();
    CleanReport report;
    std::vector<std::uint32_t> materialOf; // [triangleCount]
    report.degenerateTriangles = dropDegenerate(mesh, materialOf);
    if (mesh.indices.empty())
        return Error{
            report.degenerateTriangles == 0
                ? std::string("no triangles in the file (of glTF, in its default scene)")
                : fmt::format("none of the {} triangles has an area", report.degenerateTriangles)};

    compactMaterials(mesh, materialOf);
    if (mesh.materials.size() > kMaxMeshMaterials)
        return Error{fmt::format("{} materials, more than {}; join some", mesh.materials.size(),
                                 kMaxMeshMaterials)};
    groupByMaterial(mesh.indices, materialOf);
    mergeVertices(mesh, materialOf, report);
    if (mesh.positions.size() > kMaxMeshVertices || mesh.indices.size() / 3 > kMaxMeshTriangles)
        return Error{fmt::format(
            "{} vertices and {} triangles, above the limits of {} and {}; simplify the mesh",
            mesh.positions.size(), mesh.indices.size() / 3, kMaxMeshVertices, kMaxMeshTriangles)};
    return report;
}

} // namespace penumbra
