#include "assetc/bake/line_space.h"

#include "assetc/embree_scene.h"
#include "shaders/shared/interop.h"

#include <gtest/gtest.h>
#include <random>

namespace penumbra {

namespace {

vec3 inBall(std::mt19937& random)
{
    std::uniform_real_distribution<float> unit(-1, 1);
    for (;;)
        if (const vec3 p(unit(random), unit(random), unit(random)); dot(p, p) < 1)
            return p;
}

// Distance along w at which the line meets a triangle, if it does (Möller and Trumbore 1997).
std::optional<float> meets(vec3 p, vec3 w, vec3 a, vec3 b, vec3 c)
{
    const vec3 e = b - a, f = c - a, q = cross(w, f);
    const float det = dot(e, q);
    const vec3 s = p - a, r = cross(s, e);
    const float u = dot(s, q) / det, v = dot(w, r) / det;
    if (!(u >= 0 && v >= 0 && u + v <= 1))
        return std::nullopt;
    return dot(f, r) / det;
}

} // namespace

// Triangles from less than a pixel to most of the raster, so that all ways of drawing are taken;
// points all over the sphere, inside the mesh's hull too. What differs are lines that pass within
// a pixel of an edge.
TEST(LineSpace, FindsWhatRaysFind)
{
    std::mt19937 random(7);
    PointSet vertices, points;
    const auto add = [](PointSet& set, vec3 p) {
        set.x.push_back(p.x);
        set.y.push_back(p.y);
        set.z.push_back(p.z);
    };
    std::vector<vec3> corners;
    std::vector<std::uint32_t> indices;
    for (int t = 0; t < 60; ++t) {
        const float size = std::pow(0.5f, static_cast<float>(t % 10));
        const vec3 at = (1 - size) * inBall(random);
        for (int k = 0; k < 3; ++k) {
            corners.push_back(at + size * inBall(random));
            add(vertices, corners.back());
            indices.push_back(static_cast<std::uint32_t>(indices.size()));
        }
    }
    std::vector<vec3> at;
    for (std::size_t i = 0; i < LineSpace::kMaxLookUp; ++i)
        add(points, at.emplace_back(inBall(random)));

    LineSpace lines(512);
    RasterScratch scratch; // kept: a raster must leave nothing behind
    int wrong = 0, blockedRays = 0;
    for (int direction = 0; direction < 20; ++direction) {
        const vec3 w = normalize(inBall(random));
        lines.rasterise(w, vertices, TriangleSet(indices), scratch);
        LineSpace::BlockedParts blocked;
        const unsigned any = lines.lookUp(points, 0, at.size(), 0, blocked);
        bool seen[2] = {};
        for (std::size_t i = 0; i < at.size(); ++i) {
            bool hit[2] = {};
            for (std::size_t t = 0; t < corners.size(); t += 3)
                if (const auto d = meets(at[i], w, corners[t], corners[t + 1], corners[t + 2]))
                    hit[*d > 0 ? 0 : 1] = true;
            for (const int sign : {0, 1}) {
                wrong += (blocked[sign][i] > 0) != hit[sign] ? 1 : 0;
                blockedRays += hit[sign] ? 1 : 0;
                seen[sign] = seen[sign] || blocked[sign][i] > 0;
            }
        }
        EXPECT_EQ(any, (seen[0] ? 1u : 0u) | (seen[1] ? 2u : 0u));
    }
    EXPECT_GT(blockedRays, 2000);
    EXPECT_LT(wrong, 20 * 512 / 100); // one ray in a hundred
}

// Far outside, a direction stands for a square of lines: its part that hits is the area covered.
TEST(LineSpace, CellsAreAreas)
{
    const std::vector<std::uint32_t> indices = {0, 1, 2, 2, 1, 3};
    PointSet vertices;
    vertices.x = {-0.5f, 0.5f, -0.5f, 0.5f};
    vertices.y = {-0.25f, -0.25f, 0.25f, 0.25f};
    vertices.z = {0, 0, 0, 0};
    LineSpace lines(256);
    RasterScratch scratch;
    lines.rasterise({0, 0, 1}, vertices, TriangleSet(indices), scratch);
    PointSet points;
    points.x = {0, 0, 0.5f};
    points.y = {0, 0, 0.25f};
    points.z = {-4, 4, -4};
    LineSpace::BlockedParts blocked;
    EXPECT_EQ(lines.lookUp(points, 0, 3, 0.2f, blocked), 3u); // 0.8 to each side
    const float part = 0.5f / (1.6f * 1.6f);
    EXPECT_NEAR(blocked[0][0], part, 0.01f);
    EXPECT_EQ(blocked[1][0], 0);
    EXPECT_NEAR(blocked[1][1], part, 0.01f);
    EXPECT_NEAR(blocked[0][2], 0.8f * 0.5f / (1.6f * 1.6f), 0.01f); // what reaches that far
}

TEST(EmbreeScene, DistanceIsThatOfTheNearestTriangle)
{
    const std::vector<vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                         {5, 5, 5}, {6, 5, 5}, {5, 6, 5}};
    const std::vector<std::uint32_t> indices = {0, 1, 2, 3, 4, 5};
    const EmbreeScene scene(positions, indices);
    const auto expect = [&](vec3 p, float distance) {
        EXPECT_NEAR(scene.distance(p, 10), distance, 1e-5f) << p.x << " " << p.y << " " << p.z;
        EXPECT_EQ(scene.distance(p, distance * 0.5f), distance * 0.5f);
    };
    expect({0.2f, 0.2f, 0.7f}, 0.7f);   // face
    expect({0.5f, -2, 0}, 2);           // edge
    expect({1, 1, 0}, std::sqrt(0.5f)); // the long edge
    expect({-3, -4, 0}, 5);             // corner
    expect({5.2f, 5.2f, 4}, 1);         // the other triangle
}

} // namespace penumbra
