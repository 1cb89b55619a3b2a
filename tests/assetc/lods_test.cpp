#include "assetc/lods.h"

#include "assetc/order.h"
#include "assets/mesh_codec.h"
#include "tests/assets/sample_assets.h"

#include <gtest/gtest.h>

namespace penumbra {

namespace {

MeshAsset sphere()
{
    MeshAsset mesh = sampleMesh(32);
    orderClusters(mesh);
    EXPECT_TRUE(quantizeMesh(mesh));
    return mesh;
}

// Distance of a point from the nearest triangle's plane region, by its nearest corner or face: an
// upper bound that sampling of corners and centres makes good enough for a law.
float distanceTo(const MeshGeometry& mesh, vec3 p)
{
    float nearest = 1e9f;
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
        const vec3 a = mesh.positions[mesh.indices[t]];
        const vec3 b = mesh.positions[mesh.indices[t + 1]];
        const vec3 c = mesh.positions[mesh.indices[t + 2]];
        for (int i = 0; i <= 4; ++i)
            for (int j = 0; i + j <= 4; ++j) {
                const float u = static_cast<float>(i) / 4;
                const float v = static_cast<float>(j) / 4;
                nearest = min(nearest, length(p - (a + u * (b - a) + v * (c - a))));
            }
    }
    return nearest;
}

} // namespace

TEST(Lods, EachHasHalfTheTrianglesAndKnowsItsError)
{
    MeshAsset mesh = sphere();
    buildLods(mesh, 3);
    ASSERT_EQ(mesh.lods.size(), 3u);
    std::size_t previous = mesh.indices.size();
    float error = 0;
    for (const MeshLod& lod : mesh.lods) {
        EXPECT_NEAR(static_cast<double>(lod.indices.size()) / static_cast<double>(previous), 0.5,
                    0.05);
        EXPECT_GT(lod.error, error);
        EXPECT_LT(lod.error, 0.2f);
        EXPECT_EQ(lod.clusters.size(), (lod.positions.size() + 63) / 64);
        previous = lod.indices.size();
        error = lod.error;
    }
    ASSERT_TRUE(validateMesh(mesh));
    // Measured from all vertices, as here.
    float worst = 0;
    const MeshLod& last = mesh.lods.back();
    for (std::size_t i = 0; i < mesh.positions.size(); i += 37)
        worst = max(worst, distanceTo(last, mesh.positions[i]));
    EXPECT_LT(worst, last.error + 0.05f); // 0.05: samples of the triangles
}

// A simplifier drops small parts whole, at no cost that it sees: levels that do are not made.
TEST(Lods, PartsThatGoCountAsError)
{
    MeshAsset mesh;
    for (std::uint32_t part = 0; part < 512; ++part) {
        const vec3 at(part % 8, part / 8 % 8, part / 64);
        for (const vec2 corner : {vec2{0, 0}, vec2{1, 0}, vec2{0, 1}, vec2{1, 1}}) {
            mesh.positions.push_back(at + 0.02f * vec3(corner, 0));
            mesh.normals.emplace_back(0, 0, 1);
        }
        for (const std::uint32_t i : {0, 1, 2, 2, 1, 3})
            mesh.indices.push_back(4 * part + i);
    }
    buildLods(mesh, 4);
    EXPECT_TRUE(mesh.lods.empty()) << mesh.lods.back().error;
}

// Vertices of a level are vertices of the mesh, with all they have.
TEST(Lods, AttributesFollowVertices)
{
    MeshAsset mesh = sphere();
    for (const vec3 p : mesh.positions) {
        mesh.texcoords0.emplace_back(p.x, p.y);
        mesh.colors.push_back({static_cast<std::uint8_t>(100 + 90 * p.z), 1, 2, 3});
    }
    buildLods(mesh, 1);
    ASSERT_EQ(mesh.lods.size(), 1u);
    const MeshLod& lod = mesh.lods[0];
    ASSERT_EQ(lod.texcoords0.size(), lod.positions.size());
    ASSERT_EQ(lod.selfVisibility.size(), lod.positions.size());
    for (std::size_t i = 0; i < lod.positions.size(); ++i) {
        const vec3 p = lod.positions[i];
        EXPECT_EQ(lod.texcoords0[i], (vec2{p.x, p.y}));
        EXPECT_EQ(lod.colors[i][0], static_cast<std::uint8_t>(100 + 90 * p.z));
        const auto at = std::find(mesh.positions.begin(), mesh.positions.end(), p);
        ASSERT_NE(at, mesh.positions.end());
        const auto source = static_cast<std::size_t>(at - mesh.positions.begin());
        EXPECT_EQ(lod.selfVisibility[i], mesh.selfVisibility[source]);
    }
}

TEST(Lods, SubmeshesStayApart)
{
    MeshAsset mesh = sampleScene();
    mesh.lods.clear();
    buildLods(mesh, 1);
    ASSERT_EQ(mesh.lods.size(), 1u);
    EXPECT_EQ(mesh.lods[0].submeshes.size(), 2u);
    const auto valid = validateMesh(mesh);
    EXPECT_TRUE(valid) << valid.error().message;
    EXPECT_TRUE(decodeMeshAsset(*encodeMeshAsset(mesh)));
}

// Two triangles of a square do without none: no level, rather than one that is not the mesh.
TEST(Lods, StopWhereNothingCanGo)
{
    MeshAsset mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.normals.assign(3, vec3{0, 0, 1});
    mesh.selfVisibility.resize(3);
    mesh.indices = {0, 1, 2};
    updateDerived(mesh);
    buildLods(mesh, 4);
    EXPECT_TRUE(mesh.lods.empty());
}

TEST(Lods, AreDeterministic)
{
    MeshAsset a = sphere();
    MeshAsset b = sphere();
    buildLods(a, 2);
    buildLods(b, 2);
    EXPECT_EQ(*encodeMeshAsset(a), *encodeMeshAsset(b));
}

} // namespace penumbra
