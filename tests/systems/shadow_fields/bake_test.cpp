// Baked fields against closed forms and against themselves.
#include "assetc/bake.h"
#include "shaders/shared/field.h"
#include "tests/systems/shadow_fields/test_scene.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

namespace penumbra {
namespace {

BakeResult bake(const MeshAsset& mesh, std::uint32_t threads)
{
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    Progress progress("test");
    return bakeMesh(mesh.positions, mesh.normals, mesh.indices,
                    {.shells = 8, .side = 9, .directions = 1024, .rasterSide = 256}, progress);
}

// Seen from distance r, a sphere of radius 1 hides the solid angle 2 pi (1 - sqrt(1 - 1/r²)), so
// band 0 of visibility is sqrt(4 pi) minus that over sqrt(4 pi).
TEST(Bake, SphereHidesItsSolidAngle)
{
    const MeshAsset sphere = makeSphereAsset(0.7f, 48, false);
    const FieldSamples samples = bake(sphere, 2).field;
    const ShadowField& field = samples.head;
    EXPECT_NEAR(field.radius, 0.7, 0.005);
    EXPECT_LT(length(field.center), 0.005);
    for (std::size_t shell = 4; shell < 8; ++shell) { // those outside the sphere
        const double r = static_cast<double>(shellRadius(field, shell));
        const double hidden = 2 * M_PI * (1 - std::sqrt(1 - 1 / (r * r)));
        // Far away whole cells of directions count, and the silhouette is all that errs; at 1.65
        // radii the cells are small against it.
        const double tolerance = shell == 4 ? 0.03 : 0.015;
        // A direction is 4 pi / 1024 sr, of which the squares of the cells miss or share a part.
        const double cells = 0.5 * 4 * M_PI / 1024;
        for (std::size_t i = 0; i < 81; i += 7)
            EXPECT_NEAR(-static_cast<double>(samples.nodes[shell * 81 + i].c[0]),
                        hidden / std::sqrt(4 * M_PI),
                        (tolerance * hidden + cells) / std::sqrt(4 * M_PI))
                << shell << ' ' << i;
    }
}

// Inside the sphere nothing is seen: what is stored there continues the first shells outside.
TEST(Bake, InsideContinuesTheSpaceAround)
{
    const MeshAsset sphere = makeSphereAsset(0.7f, 48, false);
    const FieldSamples samples = bake(sphere, 2).field;
    const float outside = samples.nodes[4 * 81].c[0]; // r = 1.65
    for (std::size_t i = 0; i < 8 * 81; ++i) {
        EXPECT_EQ(samples.inside[i], i < 4 * 81) << i; // the fourth shell has r = 0.97
        if (i < 4 * 81) {
            EXPECT_NEAR(samples.nodes[i].c[0], outside, 0.05f * std::abs(outside)) << i;
        }
    }
}

TEST(Bake, ConvexMeshLeavesItsVerticesOpen)
{
    for (const MeshAsset& mesh :
         {makeSphereAsset(1, 24, false), makeBoxAsset(vec3(1, 0.5f, 0.7f), 8, false)})
        for (const SelfVisibility& v : bake(mesh, 2).selfVisibility)
            for (const std::uint8_t q : v)
                EXPECT_NEAR(q, 128, 1);
}

TEST(Bake, SameBytesForAnyThreadCount)
{
    const MeshAsset box = makeBoxAsset(vec3(0.2f, 1, 0.5f), 6, false);
    const BakeResult one = bake(box, 1), two = bake(box, 2);
    const ShadowField field = quantiseField(one.field), other = quantiseField(two.field);
    EXPECT_EQ(field.texels, other.texels);
    EXPECT_EQ(field.bandScale, other.bandScale);
    EXPECT_EQ(one.selfVisibility, two.selfVisibility);
    EXPECT_TRUE(validateField(field).ok());
}

} // namespace
} // namespace penumbra
