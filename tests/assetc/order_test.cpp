#include "assetc/order.h"
#include "tests/assets/sample_assets.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <numeric>

namespace penumbra {

namespace {

// A triangle by its positions, the same for any vertex numbering and any first corner.
using Corners = std::array<std::array<float, 3>, 3>;

std::vector<Corners> triangleSet(const MeshAsset& mesh)
{
    std::vector<Corners> set;
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
        Corners corners;
        for (std::size_t k = 0; k < 3; ++k) {
            const vec3 p = mesh.positions[mesh.indices[t + k]];
            corners[k] = {p.x, p.y, p.z};
        }
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()),
                    corners.end());
        set.push_back(corners);
    }
    std::sort(set.begin(), set.end());
    return set;
}

MeshAsset shuffled()
{
    MeshAsset mesh = sampleMesh(40);
    std::vector<std::uint32_t> order(mesh.positions.size());
    std::iota(order.begin(), order.end(), 0u);
    std::shuffle(order.begin(), order.end(), std::mt19937(2));
    applyOrder(mesh, order);
    return mesh;
}

} // namespace

TEST(OrderClusters, KeepsTheSurface)
{
    MeshAsset mesh = shuffled();
    const auto before = triangleSet(mesh);
    orderClusters(mesh);
    EXPECT_EQ(triangleSet(mesh), before);
}

TEST(OrderClusters, BothCandidatesArePermutations)
{
    const MeshAsset mesh = shuffled();
    for (auto order : {orderByMeshlets(mesh), orderByMedianSplit(mesh)}) {
        std::sort(order.begin(), order.end());
        std::vector<std::uint32_t> all(mesh.positions.size());
        std::iota(all.begin(), all.end(), 0u);
        EXPECT_EQ(order, all);
    }
}

// n clusters tile a sphere of radius 1: a disc of equal area has radius 2/sqrt(n); good clusters
// stay near it.
TEST(OrderClusters, ClustersAreCompact)
{
    MeshAsset mesh = shuffled();
    const float bad = measureClusters(mesh).meanRadius;
    const OrderReport report = orderClusters(mesh);
    const auto clusters = static_cast<float>((mesh.positions.size() + 63) / 64);
    const float disc =
        2 / std::sqrt(clusters) / std::sqrt(3.0f); // bounding radius: half the box's diagonal
    EXPECT_GT(bad, 2 * report.quality.meanRadius);
    EXPECT_LT(report.quality.meanRadius, 1.7f * disc);
    EXPECT_GT(report.quality.meanCutoff, 0.5f);
}

TEST(OrderClusters, TakesTheCheaperCandidate)
{
    const MeshAsset mesh = shuffled();
    MeshAsset best = mesh;
    const OrderReport report = orderClusters(best);
    for (const auto& order : {orderByMeshlets(mesh), orderByMedianSplit(mesh)}) {
        MeshAsset candidate = mesh;
        applyOrder(candidate, order);
        EXPECT_LE(report.quality.cost, measureClusters(candidate).cost);
    }
}

TEST(OrderClusters, IsDeterministic)
{
    MeshAsset a = shuffled();
    MeshAsset b = shuffled();
    orderClusters(a);
    orderClusters(b);
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.indices, b.indices);
}

} // namespace penumbra
