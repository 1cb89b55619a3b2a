#include "assetc/light/shape_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace penumbra {

namespace {

constexpr std::uint32_t kRectangleCells = 8; // per side: light varies over a large one
constexpr std::uint32_t kDiscRings = 4, kDiscSectors = 48;
constexpr int kSphereSplits = 3; // 642 vertices

// Vertices of one side in the plane z = 0, rings or rows; `back` is the same seen from behind. The
// picture of the light covers `size` around the origin, its row 0 on top.
void addSide(MeshAsset& mesh, const std::vector<vec2>& points, vec2 size,
             const std::vector<std::uint32_t>& indices, bool back)
{
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const vec2 p : points) {
        mesh.positions.emplace_back(p.x, p.y, 0);
        mesh.texcoords0.emplace_back(0.5f + p.x / size.x, 0.5f - p.y / size.y);
        mesh.normals.emplace_back(0, 0, back ? -1 : 1);
    }
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        mesh.indices.push_back(first + indices[i]);
        mesh.indices.push_back(first + indices[i + (back ? 2 : 1)]);
        mesh.indices.push_back(first + indices[i + (back ? 1 : 2)]);
    }
}

MeshAsset makeRectangle(vec2 size, bool twoSided)
{
    std::vector<vec2> points;
    std::vector<std::uint32_t> indices;
    constexpr std::uint32_t kRow = kRectangleCells + 1;
    for (std::uint32_t y = 0; y < kRow; ++y)
        for (std::uint32_t x = 0; x < kRow; ++x)
            points.push_back((vec2(x, y) / static_cast<float>(kRectangleCells) - 0.5f) * size);
    for (std::uint32_t y = 0; y < kRectangleCells; ++y)
        for (std::uint32_t x = 0; x < kRectangleCells; ++x) {
            const std::uint32_t i = y * kRow + x;
            for (const std::uint32_t k : {i, i + 1, i + kRow + 1, i, i + kRow + 1, i + kRow})
                indices.push_back(k);
        }
    MeshAsset mesh;
    addSide(mesh, points, size, indices, false);
    if (twoSided)
        addSide(mesh, points, size, indices, true);
    return mesh;
}

MeshAsset makeDisc(float radius, bool twoSided)
{
    std::vector<vec2> points = {vec2(0)};
    std::vector<std::uint32_t> indices;
    for (std::uint32_t ring = 1; ring <= kDiscRings; ++ring)
        for (std::uint32_t sector = 0; sector < kDiscSectors; ++sector) {
            const double angle = 2 * std::numbers::pi * sector / kDiscSectors;
            points.push_back(vec2(std::cos(angle), std::sin(angle)) *
                             (radius * static_cast<float>(ring) / kDiscRings));
        }
    for (std::uint32_t sector = 0; sector < kDiscSectors; ++sector) {
        const std::uint32_t next = (sector + 1) % kDiscSectors;
        for (const std::uint32_t k : {0u, 1 + sector, 1 + next})
            indices.push_back(k);
        for (std::uint32_t ring = 1; ring < kDiscRings; ++ring) {
            const std::uint32_t in = 1 + (ring - 1) * kDiscSectors, out = in + kDiscSectors;
            for (const std::uint32_t k :
                 {in + sector, out + sector, out + next, in + sector, out + next, in + next})
                indices.push_back(k);
        }
    }
    MeshAsset mesh;
    addSide(mesh, points, vec2(2 * radius), indices, false);
    if (twoSided)
        addSide(mesh, points, vec2(2 * radius), indices, true);
    return mesh;
}

} // namespace

MeshAsset makeIcosphere(int splits)
{
    const float g = std::numbers::phi_v<float>;
    MeshAsset mesh;
    for (const vec3 p : {vec3(-1, g, 0), vec3(1, g, 0), vec3(-1, -g, 0), vec3(1, -g, 0),
                         vec3(0, -1, g), vec3(0, 1, g), vec3(0, -1, -g), vec3(0, 1, -g),
                         vec3(g, 0, -1), vec3(g, 0, 1), vec3(-g, 0, -1), vec3(-g, 0, 1)})
        mesh.positions.push_back(normalize(p));
    mesh.indices = {0, 11, 5,  0, 5,  1, 0, 1, 7, 0, 7,  10, 0, 10, 11, 1, 5, 9, 5, 11,
                    4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3,  9,  4, 3,  4,  2, 3, 2, 6, 3,
                    6, 8,  3,  8, 9,  4, 9, 5, 2, 4, 11, 6,  2, 10, 8,  6, 7, 9, 8, 1};
    for (int split = 0; split < splits; ++split) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto next = static_cast<std::uint32_t>(mesh.positions.size());
            const auto [at, added] = middles.try_emplace(std::minmax(a, b), next);
            if (added)
                mesh.positions.push_back(normalize(mesh.positions[a] + mesh.positions[b]));
            return at->second;
        };
        std::vector<std::uint32_t> finer;
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
            const std::uint32_t a = mesh.indices[i], b = mesh.indices[i + 1],
                                c = mesh.indices[i + 2];
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            for (const std::uint32_t k : {a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca})
                finer.push_back(k);
        }
        mesh.indices = std::move(finer);
    }
    mesh.normals = mesh.positions;
    return mesh;
}

MeshAsset makeShapeMesh(const LightSpec& spec)
{
    if (spec.shape == EmitterShape::Rectangle)
        return makeRectangle(spec.size, spec.twoSided);
    if (spec.shape != EmitterShape::Sphere)
        return makeDisc(spec.radius, spec.twoSided);
    MeshAsset mesh = makeIcosphere(kSphereSplits);
    for (vec3& position : mesh.positions)
        position *= spec.radius;
    return mesh;
}

} // namespace penumbra
