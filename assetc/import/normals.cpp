#include "assetc/import/normals.h"

#include "assetc/import/vertex_key.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <unordered_map>

namespace penumbra {

namespace {

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

// A corner's edge from the star's position to another one.
struct StarEdge {
    std::uint32_t otherPosition;
    std::uint32_t corner; // within the star
    auto operator<=>(const StarEdge&) const = default;
};

// The groups of corners around one position that share a normal.
class StarGroups {
public:
    // `corners` of one position; edges between faces that meet at less than the crease join groups.
    void build(const MeshAsset& mesh, const Stars& stars, const std::vector<dvec3>& faceNormals,
               std::span<const std::uint32_t> corners)
    {
        m_parents.resize(corners.size());
        std::iota(m_parents.begin(), m_parents.end(), 0u);
        m_edges.clear();
        for (std::uint32_t i = 0; i < corners.size(); ++i) {
            const std::uint32_t face = corners[i] - corners[i] % 3;
            m_edges.push_back({stars.positionOf[face + (corners[i] + 1) % 3], i});
            m_edges.push_back({stars.positionOf[face + (corners[i] + 2) % 3], i});
        }
        std::sort(m_edges.begin(), m_edges.end());
        // Four faces at an edge, as where two thin sheets touch, are all compared.
        for (std::size_t e = 1; e < m_edges.size(); ++e)
            for (std::size_t back = 1; back <= std::min<std::size_t>(e, 3); ++back)
                joinAcross(m_edges[e - back], m_edges[e], faceNormals, corners);
        m_sums.assign(corners.size(), dvec3(0.0));
        for (std::uint32_t i = 0; i < corners.size(); ++i)
            m_sums[root(i)] += angleAt(mesh, corners[i]) * faceNormals[corners[i] / 3];
    }

    [[nodiscard]] vec3 normal(std::uint32_t corner, dvec3 faceNormal)
    {
        const dvec3 sum = m_sums[root(corner)];
        const double size = glm::length(sum);
        return {size > 1e-6 ? sum / size : faceNormal}; // opposite faces cancel
    }

private:
    void joinAcross(const StarEdge& a, const StarEdge& b, const std::vector<dvec3>& faceNormals,
                    std::span<const std::uint32_t> corners)
    {
        if (a.otherPosition == b.otherPosition &&
            glm::dot(faceNormals[corners[a.corner] / 3], faceNormals[corners[b.corner] / 3]) >=
                kCreaseCosine)
            m_parents[root(b.corner)] = root(a.corner);
    }

    std::uint32_t root(std::uint32_t i)
    {
        while (m_parents[i] != i)
            i = m_parents[i] = m_parents[m_parents[i]];
        return i;
    }

    std::vector<std::uint32_t> m_parents; // [cornerCount of the star]
    std::vector<StarEdge> m_edges;
    std::vector<dvec3> m_sums; // [cornerCount of the star], at roots
};

} // namespace

std::vector<vec3> cornerNormals(const MeshAsset& mesh)
{
    std::vector<vec3> result(mesh.indices.size());
    bool allGiven = true;
    for (std::size_t corner = 0; corner < result.size(); ++corner) {
        const vec3 given = mesh.normals[mesh.indices[corner]];
        result[corner] = isGiven(given) ? normalize(given) : vec3{0};
        allGiven = allGiven && isGiven(given);
    }
    if (allGiven)
        return result;

    const Stars stars = buildStars(mesh);
    std::vector<dvec3> faceNormals(mesh.indices.size() / 3);
    for (std::size_t face = 0; face < faceNormals.size(); ++face)
        faceNormals[face] = faceNormal(mesh, face);
    StarGroups groups;
    for (std::size_t position = 0; position + 1 < stars.begins.size(); ++position) {
        const std::span<const std::uint32_t> corners(stars.corners.data() + stars.begins[position],
                                                     stars.corners.data() +
                                                         stars.begins[position + 1]);
        groups.build(mesh, stars, faceNormals, corners);
        for (std::uint32_t i = 0; i < corners.size(); ++i)
            if (result[corners[i]] == vec3{0})
                result[corners[i]] = groups.normal(i, faceNormals[corners[i] / 3]);
    }
    return result;
}

} // namespace penumbra
