#include "assetc/import/clean.h"

#include "assetc/import/normals.h"
#include "assetc/import/vertex_key.h"

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

std::size_t dropDegenerate(MeshAsset& mesh)
{
    std::size_t kept = 0;
    for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
        const std::uint32_t a = mesh.indices[t];
        const std::uint32_t b = mesh.indices[t + 1];
        const std::uint32_t c = mesh.indices[t + 2];
        if (!hasArea(mesh.positions[a], mesh.positions[b], mesh.positions[c]))
            continue;
        mesh.indices[kept++] = a;
        mesh.indices[kept++] = b;
        mesh.indices[kept++] = c;
    }
    const std::size_t dropped = (mesh.indices.size() - kept) / 3;
    mesh.indices.resize(kept);
    return dropped;
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
    report.degenerateTriangles = dropDegenerate(mesh);
    if (mesh.indices.empty())
        return Error{
            report.degenerateTriangles == 0
                ? std::string("no triangles in the file (of glTF, in its default scene)")
                : fmt::format("none of the {} triangles has an area", report.degenerateTriangles)};

    // One vertex per distinct position and normal, in order of first use.
    const std::vector<vec3> normals = cornerNormals(mesh);
    std::unordered_map<FloatKey<6>, std::uint32_t, FloatKeyHash<6>> vertexOf;
    MeshAsset clean{
        .name = mesh.name, .indices = std::move(mesh.indices), .material = mesh.material};
    for (std::size_t corner = 0; corner < clean.indices.size(); ++corner) {
        const std::uint32_t source = clean.indices[corner];
        const vec3 position = mesh.positions[source] + 0.0f; // -0 becomes 0
        const auto [found, isNew] = vertexOf.emplace(
            keyOf(position, normals[corner]), static_cast<std::uint32_t>(clean.positions.size()));
        if (isNew) {
            clean.positions.push_back(position);
            clean.normals.push_back(normals[corner]);
            report.generatedNormals += mesh.normals[source] == vec3{0} ? 1 : 0;
        }
        clean.indices[corner] = found->second;
    }
    if (clean.positions.size() > kMaxMeshVertices || clean.indices.size() / 3 > kMaxMeshTriangles)
        return Error{fmt::format(
            "{} vertices and {} triangles, above the limits of {} and {}; simplify the mesh",
            clean.positions.size(), clean.indices.size() / 3, kMaxMeshVertices, kMaxMeshTriangles)};
    report.mergedVertices =
        mesh.positions.size() - std::min(mesh.positions.size(), clean.positions.size());
    mesh = std::move(clean);
    return report;
}

} // namespace penumbra
