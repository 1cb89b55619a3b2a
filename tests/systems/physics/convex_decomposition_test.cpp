#include "systems/physics/convex_decomposition.h"
#include "systems/physics/convex_hull.h"

#include <gtest/gtest.h>

namespace penumbra {
namespace {

struct Mesh {
    std::vector<vec3> positions;
    std::vector<std::uint32_t> indices;
};

// A torus about the y axis, counter-clockwise from outside.
Mesh makeTorus(float major, float minor)
{
    constexpr int kAround = 48, kSides = 24;
    Mesh mesh;
    for (int i = 0; i < kAround; ++i) {
        for (int j = 0; j < kSides; ++j) {
            const float a = 6.2831853f * static_cast<float>(i) / kAround,
                        b = 6.2831853f * static_cast<float>(j) / kSides;
            const float r = major + minor * cos(b);
            mesh.positions.push_back({r * cos(a), minor * sin(b), r * sin(a)});
            const auto at = [](int u, int v) {
                return static_cast<std::uint32_t>((u % kAround) * kSides + v % kSides);
            };
            for (const std::uint32_t index : {at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i, j),
                                              at(i + 1, j + 1), at(i + 1, j)})
                mesh.indices.push_back(index);
        }
    }
    return mesh;
}

bool inside(const ConvexHull& hull, vec3 p)
{
    for (const auto& t : hull.triangles) {
        const vec3 a = hull.points[t[0]];
        if (dot(cross(hull.points[t[1]] - a, hull.points[t[2]] - a), p - a) > 0)
            return false;
    }
    return true;
}

TEST(ConvexDecomposition, TorusKeepsItsHoleAndItsVolume)
{
    const Mesh torus = makeTorus(0.2f, 0.06f);
    const auto pieces = decompose(torus.positions, torus.indices);
    ASSERT_TRUE(pieces.ok());
    EXPECT_GE(pieces->size(), 6u);
    EXPECT_LE(pieces->size(), 24u);
    double volume = 0;
    for (const auto& piece : *pieces) {
        const ConvexHull hull = *convexHull(piece);
        volume += integrate(hull).volume;
        for (const vec3 p : {vec3(0), vec3(0.05f, 0, 0.05f), vec3(-0.08f, 0.03f, 0)})
            EXPECT_FALSE(inside(hull, p)) << "the hole is filled";
    }
    const double exact = 2 * 9.8696 * 0.2 * 0.06 * 0.06; // 2 π² R r²
    EXPECT_NEAR(volume, exact, 0.12 * exact);
}

TEST(ConvexDecomposition, ConvexMeshStaysWhole)
{
    const ConvexHull box = *convexHull(std::vector<vec3>{
        {0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {1, 2, 0}, {0, 0, 3}, {1, 0, 3}, {0, 2, 3}, {1, 2, 3}});
    std::vector<std::uint32_t> indices;
    for (const auto& t : box.triangles)
        indices.insert(indices.end(), t.begin(), t.end());
    const auto pieces = decompose(box.points, indices);
    ASSERT_TRUE(pieces.ok());
    ASSERT_EQ(pieces->size(), 1u);
    EXPECT_NEAR(integrate(*convexHull((*pieces)[0])).volume, 6, 1e-3);
}

TEST(ConvexDecomposition, SameBitsTwice)
{
    const Mesh torus = makeTorus(0.2f, 0.06f);
    EXPECT_TRUE(*decompose(torus.positions, torus.indices) ==
                *decompose(torus.positions, torus.indices));
}

TEST(ConvexDecomposition, RefusesBadInput)
{
    Mesh torus = makeTorus(0.2f, 0.06f);
    EXPECT_FALSE(decompose(torus.positions, torus.indices, {.maxPieces = 0}).ok());
    EXPECT_FALSE(decompose(torus.positions, torus.indices, {.resolution = 1000}).ok());
    EXPECT_FALSE(decompose(torus.positions, {}).ok());
    EXPECT_FALSE(decompose({}, torus.indices).ok());
    for (std::size_t i = 0; i < torus.indices.size(); i += 3)
        std::swap(torus.indices[i], torus.indices[i + 1]);
    EXPECT_FALSE(decompose(torus.positions, torus.indices).ok()) << "inside out";
    torus.indices[0] = 1u << 30;
    EXPECT_FALSE(decompose(torus.positions, torus.indices).ok());
}

} // namespace
} // namespace penumbra
