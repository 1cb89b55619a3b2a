#include "systems/physics/collision_shape.h"
#include "systems/physics/convex_hull.h"

#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace penumbra {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

std::vector<vec3> boxPoints(vec3 centre, vec3 half)
{
    std::vector<vec3> points;
    for (int i = 0; i < 8; ++i)
        points.push_back(centre + half * vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
    return points;
}

vec3 sorted(vec3 v)
{
    std::sort(&v.x, &v.x + 3);
    return v;
}

TEST(CollisionShape, HullOfABoxHasTheBoxesMass)
{
    const vec3 half(0.3f, 0.1f, 0.2f);
    const CollisionShape box = *boxShape(half), hull = *hullShape(boxPoints({5, -2, 1}, half));
    EXPECT_NEAR(hull.volume(), box.volume(), 1e-5f);
    EXPECT_LT(length(hull.centreOfMass() - vec3(5, -2, 1)), 1e-4f);
    // The principal axes may come out in any order.
    EXPECT_LT(length(sorted(hull.inertia()) - sorted(box.inertia())), 1e-5f);
}

TEST(CollisionShape, CompoundOfHalvesEqualsTheWhole)
{
    const vec3 half(0.15f, 0.1f, 0.2f);
    const std::vector<std::vector<vec3>> pieces{boxPoints({-0.15f, 0, 0}, half),
                                                boxPoints({0.15f, 0, 0}, half)};
    const CollisionShape compound = *compoundShape(pieces), box = *boxShape({0.3f, 0.1f, 0.2f});
    EXPECT_NEAR(compound.volume(), box.volume(), 1e-5f);
    EXPECT_LT(length(compound.centreOfMass()), 1e-5f);
    EXPECT_LT(length(sorted(compound.inertia()) - sorted(box.inertia())), 1e-5f);
}

TEST(CollisionShape, ReducedHullKeepsTheShape)
{
    std::mt19937 random(3);
    std::vector<vec3> points;
    while (points.size() < 5000) { // a unit sphere's skin: the worst case, no point is spare
        const auto next = [&] { return static_cast<float>(random() % 20001) / 10000.0f - 1; };
        const vec3 p(next(), next(), next());
        if (length(p) > 0.1f && length(p) < 1)
            points.push_back(normalize(p));
    }
    const ConvexHull full = *convexHull(points), reduced = reduceHull(full, kMaxHullPoints);
    EXPECT_GT(full.points.size(), 2000u);
    EXPECT_LE(reduced.points.size(), kMaxHullPoints);
    EXPECT_GT(integrate(reduced).volume, 0.88 * integrate(full).volume);
    const ConvexHull box = *convexHull(boxPoints({0, 0, 0}, {1, 2, 3}));
    EXPECT_NEAR(integrate(reduceHull(box, 6 + 2)).volume, 48, 1e-3);
}

// The pieces bulge into the hole of an L, but the mass is the mesh's.
TEST(CollisionShape, MeshKeepsItsOwnMass)
{
    // An L of three unit cubes: outline in the xy plane, counter-clockwise, 1 m deep.
    const vec2 outline[] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    std::vector<vec3> positions;
    for (const float z : {0.0f, 1.0f}) {
        for (const vec2 p : outline)
            positions.push_back(vec3(p, z));
    }
    std::vector<std::uint32_t> indices;
    for (const auto& [a, b, c] :
         std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}})
        indices.insert(indices.end(), {c, b, a, a + 6, b + 6, c + 6});
    for (std::uint32_t i = 0; i < 6; ++i) {
        const std::uint32_t j = (i + 1) % 6;
        indices.insert(indices.end(), {i, j, j + 6, i, j + 6, i + 6});
    }
    const CollisionShape shape = *meshShape(positions, indices);
    EXPECT_NEAR(shape.volume(), 3, 1e-5f);
    EXPECT_LT(length(shape.centreOfMass() - vec3(5.0f / 6, 5.0f / 6, 0.5f)), 1e-5f);
    EXPECT_GT(decompose(positions, indices)->size(), 1u);
    EXPECT_FALSE(meshShape(positions, {}).ok());
}

TEST(CollisionShape, RefusesBadInput)
{
    EXPECT_FALSE(boxShape({0.1f, 0, 0.1f}).ok());
    EXPECT_FALSE(boxShape({0.1f, kNan, 0.1f}).ok());
    EXPECT_FALSE(sphereShape(-1).ok());
    EXPECT_FALSE(sphereShape(std::numeric_limits<float>::infinity()).ok());
    EXPECT_FALSE(groundShape(kNan).ok());
    EXPECT_FALSE(hullShape({}).ok());
    EXPECT_FALSE(hullShape(boxPoints({0, 0, 0}, {1, 0, 1})).ok()) << "flat";
    EXPECT_FALSE(hullShape(boxPoints({0, 0, 0}, {1, 0, 0})).ok()) << "a line";
    EXPECT_FALSE(hullShape(boxPoints({0, 0, 0}, {0, 0, 0})).ok()) << "a point";
    EXPECT_FALSE(hullShape(boxPoints({0, kNan, 0}, {1, 1, 1})).ok());
    EXPECT_FALSE(hullShape(boxPoints({0, 1e9f, 0}, {1, 1, 1})).ok());
    EXPECT_FALSE(compoundShape({}).ok());
    const std::vector<std::vector<vec3>> flatPiece{boxPoints({0, 0, 0}, {1, 1, 1}), {vec3(0)}};
    const auto refused = compoundShape(flatPiece);
    ASSERT_FALSE(refused.ok());
    EXPECT_NE(refused.error().message.find("piece 1"), std::string::npos);
}

} // namespace
} // namespace penumbra
