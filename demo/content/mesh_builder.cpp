#include "demo/content/mesh_builder.h"

#include <algorithm>
#include <glm/gtc/constants.hpp>
#include <numeric>

namespace penumbra {

namespace {

using Triangles = std::span<const std::array<std::uint32_t, 3>>;

struct Face {
    vec3 normal = vec3(0); // unit
    vec3 angles = vec3(0); // radians, at the three corners
};

Face makeFace(vec3 a, vec3 b, vec3 c)
{
    const auto angle = [](vec3 u, vec3 v) { return std::atan2(length(cross(u, v)), dot(u, v)); };
    return {normalize(cross(b - a, c - a)),
            vec3(angle(b - a, c - a), angle(c - b, a - b), angle(a - c, b - c))};
}

// The triangles around one vertex, in groups that are connected over edges that are not creases.
// corners: 3 * triangle + place. Returns the group of each corner, numbered in order of first
// corner.
std::vector<std::uint32_t> smoothGroups(std::span<const std::uint32_t> corners, Triangles triangles,
                                        std::span<const Face> faces, float creaseCosine)
{
    std::vector<std::uint32_t> group(corners.size());
    std::iota(group.begin(), group.end(), 0u);
    const auto root = [&](std::uint32_t i) {
        while (group[i] != i)
            i = group[i];
        return i;
    };
    for (std::uint32_t i = 0; i < corners.size(); ++i) {
        const auto& first = triangles[corners[i] / 3];
        const std::uint32_t next = first[(corners[i] % 3 + 1) % 3];
        for (std::uint32_t j = 0; j < corners.size(); ++j) {
            // Triangle j lies across our outgoing edge when that edge is its incoming one.
            const auto& second = triangles[corners[j] / 3];
            if (second[(corners[j] % 3 + 2) % 3] != next)
                continue;
            if (dot(faces[corners[i] / 3].normal, faces[corners[j] / 3].normal) >= creaseCosine)
                group[std::max(root(i), root(j))] = std::min(root(i), root(j));
        }
    }
    for (std::uint32_t i = 0; i < corners.size(); ++i)
        group[i] = root(i);
    return group;
}

} // namespace

void MeshBuilder::addSkin(std::span<const Ring> rings, bool looped)
{
    PENUMBRA_ASSERT(rings.size() >= 3, "{} rings span no volume", rings.size());
    PENUMBRA_ASSERT(looped || (rings.front().size() == 1 && rings.back().size() == 1), "open ends");
    const auto sides = static_cast<std::uint32_t>(rings[1].size());
    const std::size_t firstTriangle = m_triangles.size();

    std::vector<std::uint32_t> starts;
    for (const Ring& ring : rings) {
        PENUMBRA_ASSERT(ring.size() == sides || (ring.size() == 1 && !looped), "{} points, not {}",
                        ring.size(), sides);
        starts.push_back(static_cast<std::uint32_t>(m_positions.size()));
        m_positions.insert(m_positions.end(), ring.begin(), ring.end());
    }
    for (std::size_t r = 0; r + (looped ? 0 : 1) < rings.size(); ++r) {
        const std::size_t next = (r + 1) % rings.size();
        for (std::uint32_t s = 0; s < sides; ++s) {
            const std::uint32_t t = (s + 1) % sides;
            if (rings[r].size() == 1)
                addTriangle(starts[r], starts[next] + t, starts[next] + s);
            else if (rings[next].size() == 1)
                addTriangle(starts[r] + s, starts[r] + t, starts[next]);
            else
                addQuad(starts[r] + s, starts[r] + t, starts[next] + t, starts[next] + s);
        }
    }
    if (signedVolume(firstTriangle) < 0) {
        for (std::size_t i = firstTriangle; i < m_triangles.size(); ++i)
            std::swap(m_triangles[i][1], m_triangles[i][2]);
    }
}

std::uint32_t MeshBuilder::addVertex(vec3 position)
{
    m_positions.push_back(position);
    return static_cast<std::uint32_t>(m_positions.size() - 1);
}

void MeshBuilder::addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c)
{
    m_triangles.push_back({a, b, c});
}

// Cut along the shorter diagonal: rounder triangles on twisted surfaces.
void MeshBuilder::addQuad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d)
{
    const bool acShorter =
        length(m_positions[a] - m_positions[c]) <= length(m_positions[b] - m_positions[d]);
    if (acShorter) {
        addTriangle(a, b, c);
        addTriangle(a, c, d);
    } else {
        addTriangle(a, b, d);
        addTriangle(b, c, d);
    }
}

float MeshBuilder::signedVolume(std::size_t firstTriangle) const
{
    double sum = 0;
    for (const Triangle& t : std::span(m_triangles).subspan(firstTriangle))
        sum += dot(m_positions[t[0]], cross(m_positions[t[1]], m_positions[t[2]])) / 6.0;
    return static_cast<float>(sum);
}

vec3 MeshBuilder::centreOfMass() const
{
    glm::dvec3 moment(0);
    double volume = 0;
    for (const Triangle& t : m_triangles) { // tetrahedra to the origin
        const glm::dvec3 a(m_positions[t[0]]), b(m_positions[t[1]]), c(m_positions[t[2]]);
        const double v = dot(a, cross(b, c)) / 6;
        moment += v / 4 * (a + b + c);
        volume += v;
    }
    return vec3(moment / volume);
}

ContentMesh MeshBuilder::finish(std::string name, float creaseDegrees, Origin origin) const
{
    std::vector<Face> faces;
    std::vector<std::vector<std::uint32_t>> cornersOf(m_positions.size());
    for (std::uint32_t t = 0; t < m_triangles.size(); ++t) {
        const Triangle& v = m_triangles[t];
        faces.push_back(makeFace(m_positions[v[0]], m_positions[v[1]], m_positions[v[2]]));
        for (std::uint32_t k = 0; k < 3; ++k)
            cornersOf[v[k]].push_back(3 * t + k);
    }

    ContentMesh mesh{.name = std::move(name)};
    mesh.indices.resize(3 * m_triangles.size());
    const vec3 centre = origin == Origin::CentreOfMass ? centreOfMass() : vec3(0);
    const float creaseCosine = cos(glm::radians(creaseDegrees));
    for (std::size_t v = 0; v < m_positions.size(); ++v) {
        const std::vector<std::uint32_t>& corners = cornersOf[v];
        const std::vector<std::uint32_t> groups =
            smoothGroups(corners, m_triangles, faces, creaseCosine);
        for (std::uint32_t g = 0; g < corners.size(); ++g) {
            if (groups[g] != g)
                continue;
            vec3 normal(0);
            for (std::uint32_t i = g; i < corners.size(); ++i) {
                if (groups[i] != g)
                    continue;
                mesh.indices[corners[i]] = static_cast<std::uint32_t>(mesh.positions.size());
                const Face& face = faces[corners[i] / 3];
                normal += face.angles[static_cast<int>(corners[i] % 3)] * face.normal;
            }
            mesh.positions.push_back(m_positions[v] - centre);
            mesh.normals.push_back(normalize(normal));
        }
    }
    return mesh;
}

Ring ellipseRing(vec3 centre, vec3 axisX, vec3 axisY, int sides)
{
    Ring ring;
    for (int i = 0; i < sides; ++i) {
        const float angle =
            glm::two_pi<float>() * static_cast<float>(i) / static_cast<float>(sides);
        ring.push_back(centre + cos(angle) * axisX + sin(angle) * axisY);
    }
    return ring;
}

} // namespace penumbra
