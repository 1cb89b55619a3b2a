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
            if (cluster.faces.cutoff > -1) {
                EXPECT_GE(dot(normal, cluster.faces.axis), cluster.faces.cutoff);
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
    const std::vector<vec3> normals(3, vec3(0, 1, 0));
    const auto clusters = buildClusters(positions, normals, {0, 1, 2});
    ASSERT_EQ(clusters.size(), 1u);
    EXPECT_NEAR(clusters[0].faces.axis.y, 1, 1e-6f);
    EXPECT_GT(clusters[0].faces.cutoff, 0.999f);
}

TEST(MeshClusters, OppositeFacesHaveNoCone)
{
    const std::vector<vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, -1}};
    const std::vector<vec3> normals(3, vec3(0, 1, 0));
    const auto clusters = buildClusters(positions, normals, {0, 1, 2, 0, 2, 1});
    EXPECT_EQ(clusters[0].faces.cutoff, -1);
}

TEST(MeshClusters, DegenerateTrianglesAndLoneVerticesAreHarmless)
{
    const std::vector<vec3> positions(70, vec3{1, 2, 3});
    const std::vector<vec3> normals(70, vec3(0, 1, 0));
    const auto clusters = buildClusters(positions, normals, {0, 1, 2});
    ASSERT_EQ(clusters.size(), 2u);
    for (const MeshCluster& cluster : clusters) {
        EXPECT_EQ(cluster.center, (vec3{1, 2, 3}));
        EXPECT_EQ(cluster.radius, 0);
        EXPECT_EQ(cluster.faces.cutoff, -1);
    }
    EXPECT_TRUE(buildClusters({}, {}, {}).empty());
}

// Imported normals may lean away from the faces: the receivers' cone must hold them, or an occluder
// that lights them is dropped as under their horizon.
TEST(MeshClusters, LeaningVertexNormalsWidenTheirOwnConeOnly)
{
    const std::vector<vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, -1}};
    const std::vector<vec3> normals = {normalize(vec3(-1, 1, 0)), normalize(vec3(1, 1, 0)),
                                       vec3(0, 1, 0)};
    const MeshCluster cluster = buildClusters(positions, normals, {0, 1, 2})[0];
    EXPECT_GT(cluster.faces.cutoff, 0.999f);
    EXPECT_NEAR(cluster.vertices.cutoff, std::sqrt(0.5f), 1e-4f);
    for (const vec3 normal : normals)
        EXPECT_GE(dot(normal, cluster.vertices.axis), cluster.vertices.cutoff);
}

} // namespace penumbra
