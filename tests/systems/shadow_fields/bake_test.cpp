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
    const ShadowField field = bake(sphere, 2).field;
    EXPECT_NEAR(field.radius, 0.7, 0.005);
    EXPECT_LT(length(field.center), 0.005);
    for (std::size_t shell = 4; shell < 8;
         ++shell) { // shells outside the sphere: r = 0.2 * 40^(s/7)
        const double r = 0.2 * std::pow(40.0, static_cast<double>(shell) / 7);
        const double hidden = 2 * M_PI * (1 - std::sqrt(1 - 1 / (r * r)));
        const double scale = field.bandScale[0] / (0.25 + r * r);
        for (std::size_t i = 0; i < 81; i += 7) {
            const double c0 =
                std::sqrt(4 * M_PI) + scale * (field.texels[(shell * 81 + i) * 16] - 128);
            // 1024 directions and a raster of 256: a few directions at the rim are counted wrong.
            EXPECT_NEAR(std::sqrt(4 * M_PI) - c0, hidden / std::sqrt(4 * M_PI),
                        0.03 * hidden + 0.006)
                << shell << ' ' << i;
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
    EXPECT_EQ(one.field.texels, two.field.texels);
    EXPECT_EQ(one.field.bandScale, two.field.bandScale);
    EXPECT_EQ(one.selfVisibility, two.selfVisibility);
    EXPECT_TRUE(validateField(one.field).ok());
}

} // namespace
} // namespace penumbra
