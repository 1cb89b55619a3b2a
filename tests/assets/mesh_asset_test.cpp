#include "assets/mesh_asset.h"

#include "tests/assets/sample_assets.h"

#include <gtest/gtest.h>

namespace penumbra {

// The law that culling relies on: a cluster's sphere and cone hold every triangle that touches one
// of its vertices.
TEST(MeshClusters, BoundsHoldEveryTouchingTriangle)
{
    const MeshAsset mesh = sampleMesh(20);
    ASSERT_EQ(mesh.clusters.size(), (mesh.positions.size() + 63) / 64);
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
        const vec3 a = mesh.positions[mesh.indices[t]];
        const vec3 b = mesh.positions[mesh.indices[t + 1]];
        const vec3 c = mesh.positions[mesh.indices[t + 2]];
        const vec3 normal = normalize(cross(b - a, c - a));
        for (int corner = 0; corner < 3; ++corner) {
            const MeshCluster& cluster =
                mesh.clusters[mesh.indices[t + static_cast<std::size_t>(corner)] / 64];
            for (const vec3 point : {a, b, c})
                EXPECT_LE(length(point - cluster.center), cluster.radius);
            if (cluster.coneCutoff > -1) {
                EXPECT_GE(dot(normal, cluster.coneAxis), cluster.coneCutoff);
            }
        }
    }
}

TEST(MeshClusters, SphereIsTight)
{
    const MeshAsset mesh = sampleMesh(3); // one cluster: nearly the unit ball
    ASSERT_EQ(mesh.clusters.size(), 1u);
    EXPECT_LT(mesh.clusters[0].radius, 1.12f);
}

TEST(MeshClusters, FlatPatchHasANarrowCone)
{
    const std::vector<vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, -1}};
    const auto clusters = buildClusters(positions, {0, 1, 2});
    ASSERT_EQ(clusters.size(), 1u);
    EXPECT_NEAR(clusters[0].coneAxis.y, 1, 1e-6f);
    EXPECT_GT(clusters[0].coneCutoff, 0.999f);
}

TEST(MeshClusters, OppositeFacesHaveNoCone)
{
    const std::vector<vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, -1}};
    const auto clusters = buildClusters(positions, {0, 1, 2, 0, 2, 1});
    EXPECT_EQ(clusters[0].coneCutoff, -1);
}

TEST(MeshClusters, DegenerateTrianglesAndLoneVerticesAreHarmless)
{
    const std::vector<vec3> positions(70, vec3{1, 2, 3});
    const auto clusters = buildClusters(positions, {0, 1, 2});
    ASSERT_EQ(clusters.size(), 2u);
    for (const MeshCluster& cluster : clusters) {
        EXPECT_EQ(cluster.center, (vec3{1, 2, 3}));
        EXPECT_EQ(cluster.radius, 0);
        EXPECT_EQ(cluster.coneCutoff, -1);
    }
    EXPECT_TRUE(buildClusters({}, {}).empty());
}

} // namespace penumbra
