#include "assetc/import/clean.h"
#include "tests/assets/sample_assets.h"

#include <gtest/gtest.h>
#include <limits>

namespace penumbra {

namespace {

// A unit cube of 8 vertices without normals.
MeshAsset cube()
{
    MeshAsset mesh;
    for (std::uint32_t i = 0; i < 8; ++i)
        mesh.positions.emplace_back(i & 1, i >> 1 & 1, i >> 2 & 1);
    mesh.normals.assign(8, vec3{0});
    mesh.indices = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                    2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
    return mesh;
}

} // namespace

TEST(CleanMesh, CubeEdgesStaySharp)
{
    MeshAsset mesh = cube();
    const auto report = cleanMesh(mesh);
    ASSERT_TRUE(report);
    EXPECT_EQ(mesh.positions.size(), 24u);
    EXPECT_EQ(report->generatedNormals, 24u);
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
        const vec3 a = mesh.positions[mesh.indices[t]];
        const vec3 face = normalize(cross(mesh.positions[mesh.indices[t + 1]] - a,
                                          mesh.positions[mesh.indices[t + 2]] - a));
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_LT(length(mesh.normals[mesh.indices[t + k]] - face), 1e-6f);
    }
}

TEST(CleanMesh, GentleEdgesAreSmooth)
{
    MeshAsset mesh = sampleMesh(16);
    const std::size_t vertexCount = mesh.positions.size();
    mesh.normals.assign(vertexCount, vec3{0});
    ASSERT_TRUE(cleanMesh(mesh));
    EXPECT_EQ(mesh.positions.size(), vertexCount); // no vertex was split
    for (std::size_t i = 0; i < vertexCount; ++i)
        EXPECT_GT(dot(mesh.normals[i], normalize(mesh.positions[i])), 0.85f); // bumps of 0.1
}

// Triangles that share positions but not vertices are one surface.
TEST(CleanMesh, SoupIsWeldedByExactPosition)
{
    const MeshAsset closed = sampleMesh(16);
    MeshAsset soup;
    for (const std::uint32_t index : closed.indices) {
        soup.indices.push_back(static_cast<std::uint32_t>(soup.positions.size()));
        soup.positions.push_back(closed.positions[index]);
        soup.normals.emplace_back(0);
    }
    const auto report = cleanMesh(soup);
    ASSERT_TRUE(report);
    EXPECT_EQ(soup.positions.size(), closed.positions.size());
    EXPECT_EQ(report->mergedVertices, closed.indices.size() - closed.positions.size());
}

TEST(CleanMesh, DropsDegenerateTrianglesAndUnusedVertices)
{
    MeshAsset mesh;
    mesh.positions = {{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {2, 0, 0}};
    mesh.normals.assign(6, {0, 0, 3}); // not unit
    mesh.indices = {1, 2, 3, 1, 1, 2, 1, 4, 3, 1, 2, 5};
    const auto report = cleanMesh(mesh);
    ASSERT_TRUE(report);
    EXPECT_EQ(report->degenerateTriangles, 3u);
    EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_EQ(mesh.positions.size(), 3u);
    EXPECT_EQ(mesh.normals[0], (vec3{0, 0, 1}));
}

TEST(CleanMesh, GivenNormalsSurviveBesideMissingOnes)
{
    MeshAsset mesh = cube();
    mesh.normals[0] = {0.6f, 0, 0.8f};
    ASSERT_TRUE(cleanMesh(mesh));
    int kept = 0;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        kept += mesh.normals[i] == vec3{0.6f, 0, 0.8f} ? 1 : 0;
    EXPECT_EQ(kept, 1);
}

TEST(CleanMesh, RefusesWhatCannotBeBaked)
{
    MeshAsset empty;
    EXPECT_FALSE(cleanMesh(empty));
    MeshAsset flat;
    flat.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    flat.normals.assign(3, vec3{0});
    flat.indices = {0, 1, 2};
    const auto report = cleanMesh(flat);
    ASSERT_FALSE(report);
    EXPECT_NE(report.error().message.find("area"), std::string::npos);
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(),
                            std::numeric_limits<float>::infinity(), -1e20f}) {
        MeshAsset mesh = cube();
        mesh.positions[5].y = bad;
        EXPECT_FALSE(cleanMesh(mesh)) << bad;
    }
}

// The tip of a sharp cone is one vertex, though faces across it differ by far more than the crease:
// only edges count.
TEST(CleanMesh, TipOfAConeIsNotSplit)
{
    MeshAsset mesh;
    constexpr std::uint32_t kRim = 24;
    mesh.positions.emplace_back(0, 2, 0);
    for (std::uint32_t i = 0; i < kRim; ++i) {
        const float angle = 6.28318531f * static_cast<float>(i) / static_cast<float>(kRim);
        mesh.positions.emplace_back(cos(angle), 0, -sin(angle));
        mesh.indices.insert(mesh.indices.end(), {0, 1 + i, 1 + (i + 1) % kRim});
    }
    mesh.normals.assign(mesh.positions.size(), vec3{0});
    ASSERT_TRUE(cleanMesh(mesh));
    EXPECT_EQ(mesh.positions.size(), kRim + 1);
    EXPECT_LT(length(mesh.normals[0] - vec3(0, 1, 0)), 1e-6f);
}

// A fan around one position must not cost the square of its size.
TEST(CleanMesh, CrowdedPositionIsLinear)
{
    MeshAsset mesh;
    constexpr std::uint32_t kRim = 200000;
    mesh.positions.emplace_back(0, 1, 0);
    for (std::uint32_t i = 0; i < kRim; ++i) {
        const float angle = 6.28318531f * static_cast<float>(i) / static_cast<float>(kRim);
        mesh.positions.emplace_back(100 * cos(angle), 0, -100 * sin(angle));
        mesh.indices.insert(mesh.indices.end(), {0, 1 + i, 1 + (i + 1) % kRim});
    }
    mesh.normals.assign(mesh.positions.size(), vec3{0});
    ASSERT_TRUE(cleanMesh(mesh));
    EXPECT_GT(mesh.normals[0].y, 0.9f);
}

} // namespace penumbra
