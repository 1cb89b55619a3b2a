#include "assetc/import/normals.h"

#include "assetc/import/vertex_key.h"

#include <algorithm>
#include <unordered_map>

namespace penumbra {

namespace {

constexpr std::size_t kMaxCompared = 256; // bounds the quadratic work around one position

using glm::dvec3;

// Corners by welded position, as begins and entries.
struct Stars {
    std::vector<std::uint32_t> positionOf; // [cornerCount]
    std::vector<std::uint32_t> begins;     // [positionCount + 1]
    std::vector<std::uint32_t> corners;    // [cornerCount] ascending within a position
};

Stars buildStars(const MeshAsset& mesh)
{
    Stars stars;
    std::unordered_map<FloatKey<3>, std::uint32_t, FloatKeyHash<3>> ids;
    std::vector<std::uint32_t> idOfVertex(mesh.positions.size());
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        idOfVertex[v] =
            ids.emplace(keyOf(mesh.positions[v]), static_cast<std::uint32_t>(ids.size()))
                .first->second;
    stars.begins.assign(ids.size() + 1, 0);
    for (const std::uint32_t vertex : mesh.indices) {
        stars.positionOf.push_back(idOfVertex[vertex]);
        ++stars.begins[idOfVertex[vertex] + 1];
    }
    for (std::size_t i = 0; i + 1 < stars.begins.size(); ++i)
        stars.begins[i + 1] += stars.begins[i];
    stars.corners.resize(mesh.indices.size());
    std::vector<std::uint32_t> ends(stars.begins.begin(), stars.begins.end() - 1);
    for (std::uint32_t corner = 0; corner < mesh.indices.size(); ++corner)
        stars.corners[ends[stars.positionOf[corner]]++] = corner;
    return stars;
}

double angleAt(const MeshAsset& mesh, std::uint32_t corner)
{
    const std::uint32_t face = corner - corner % 3;
    const dvec3 at(mesh.positions[mesh.indices[corner]]);
    const dvec3 a = dvec3(mesh.positions[mesh.indices[face + (corner + 1) % 3]]) - at;
    const dvec3 b = dvec3(mesh.positions[mesh.indices[face + (corner + 2) % 3]]) - at;
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

dvec3 faceNormal(const MeshAsset& mesh, std::size_t face)
{
    const dvec3 a(mesh.positions[mesh.indices[3 * face]]);
    const dvec3 b(mesh.positions[mesh.indices[3 * face + 1]]);
    const dvec3 c(mesh.positions[mesh.indices[3 * face + 2]]);
    return glm::normalize(glm::cross(b - a, c - a));
}

bool isGiven(vec3 normal)
{
    const float squared = dot(normal, normal);
    return squared > 1e-12f && squared < 1e12f; // false for NaN
}

} // namespace

std::vector<vec3> cornerNormals(const MeshAsset& mesh)
{
    std::vector<vec3> result(mesh.indices.size());
    const bool allGiven =
        std::all_of(mesh.indices.begin(), mesh.indices.end(),
                    [&](std::uint32_t vertex) { return isGiven(mesh.normals[vertex]); });
    const Stars stars = allGiven ? Stars{} : buildStars(mesh);
    std::vector<dvec3> faceNormals(allGiven ? 0 : mesh.indices.size() / 3);
    for (std::size_t face = 0; face < faceNormals.size(); ++face)
        faceNormals[face] = faceNormal(mesh, face);

    for (std::uint32_t corner = 0; corner < result.size(); ++corner) {
        if (const vec3 given = mesh.normals[mesh.indices[corner]]; isGiven(given)) {
            result[corner] = normalize(given);
            continue;
        }
        const std::uint32_t position = stars.positionOf[corner];
        const std::uint32_t begin = stars.begins[position];
        const std::uint32_t end = stars.begins[position + 1];
        const dvec3 own = faceNormals[corner / 3];
        dvec3 sum(0.0);
        // Around a crowded position all corners share the sum of the first ones, so the work stays
        // linear.
        const bool crowded = end - begin > kMaxCompared;
        for (std::uint32_t i = begin; i < std::min<std::size_t>(end, begin + kMaxCompared); ++i) {
            const dvec3 other = faceNormals[stars.corners[i] / 3];
            if (crowded || glm::dot(own, other) >= kCreaseCosine)
                sum += angleAt(mesh, stars.corners[i]) * other;
        }
        const double size = glm::length(sum);
        result[corner] = vec3(size > 1e-6 ? sum / size : own);
    }
    return result;
}

} // namespace penumbra
