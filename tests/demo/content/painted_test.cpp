// Shapes with colours: whole, closed along their seams, the same bytes each time.
#include "assets/glb.h"
#include "demo/content/painted.h"
#include "runtime/file.h"

#include <cstring>
#include <gtest/gtest.h>
#include <set>

namespace penumbra {
namespace {

TEST(Painted, EveryVertexHasItsColourOrCoordinates)
{
    for (const PaintedShape& shape : paintedShapes()) {
        const PaintedMesh painted = shape.make();
        const std::size_t count = painted.mesh.positions.size();
        EXPECT_EQ(painted.mesh.name, shape.name);
        EXPECT_EQ(painted.mesh.normals.size(), count);
        for (const std::uint32_t index : painted.mesh.indices)
            ASSERT_LT(index, count);
        EXPECT_EQ(painted.picture.has_value(), !painted.texcoords.empty());
        EXPECT_TRUE(painted.texcoords.empty() || painted.texcoords.size() == count);
        EXPECT_TRUE(painted.colors.empty() || painted.colors.size() == count);
        EXPECT_TRUE(painted.picture || !painted.colors.empty());
        for (const vec2 uv : painted.texcoords)
            EXPECT_TRUE(uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1);
        EXPECT_EQ(findPainted(shape.name), &shape);
    }
    EXPECT_EQ(findPainted("ball"), nullptr);
}

// The first and the last column of the ball's picture meet: vertices there are in pairs, so that
// welding by position closes it.
TEST(Painted, TheBallIsClosedAndLooksOutwards)
{
    const PaintedMesh ball = makeBeachBall();
    std::set<std::array<float, 3>> places;
    for (const vec3& p : ball.mesh.positions)
        places.insert({p.x + 0.0f, p.y + 0.0f, p.z + 0.0f});
    EXPECT_EQ(places.size(), 39u * 64 + 2);
    for (std::size_t i = 0; i < ball.mesh.indices.size(); i += 3) {
        const vec3 a = ball.mesh.positions[ball.mesh.indices[i]];
        const vec3 b = ball.mesh.positions[ball.mesh.indices[i + 1]];
        const vec3 c = ball.mesh.positions[ball.mesh.indices[i + 2]];
        ASSERT_GT(dot(cross(b - a, c - a), a + b + c), 0) << "triangle " << i / 3;
    }
}

TEST(Painted, FilesAreGltfAndTheSameEachTime)
{
    const std::filesystem::path folder = testing::TempDir();
    for (const PaintedShape& shape : paintedShapes()) {
        std::vector<std::byte> files[2];
        for (std::vector<std::byte>& file : files) {
            const std::filesystem::path path = folder / "painted.glb";
            ASSERT_TRUE(writePainted(path, shape.make()));
            Result<std::vector<std::byte>> bytes = readFile(path, 16u << 20);
            ASSERT_TRUE(bytes);
            file = std::move(*bytes);
        }
        EXPECT_EQ(files[0], files[1]);
        const Result<GlbView> glb = readGlb(files[0]);
        ASSERT_TRUE(glb) << glb.error().message;
        EXPECT_NE(glb->json.find(shape.name), std::string_view::npos);
    }
}

} // namespace
} // namespace penumbra
