// Laws that every generated shape obeys: closed, outward, unit normals, in budget, the same bytes
// each time.
#include "demo/content/profile.h"
#include "demo/content/shapes.h"
#include "runtime/file.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>
#include <map>
#include <sstream>

namespace penumbra {
namespace {

struct ByPosition {
    bool operator()(const vec3& a, const vec3& b) const
    {
        return std::memcmp(&a, &b, sizeof(vec3)) < 0;
    }
};

// Vertex number after welding equal positions.
std::vector<std::uint32_t> weld(const ContentMesh& mesh)
{
    std::map<vec3, std::uint32_t, ByPosition> numbers;
    std::vector<std::uint32_t> result;
    for (const vec3& p : mesh.positions) // + 0: -0 and 0 are one place
        result.push_back(numbers.try_emplace(p + 0.0f, static_cast<std::uint32_t>(numbers.size()))
                             .first->second);
    return result;
}

// Edges that are not in exactly two triangles, once per direction.
int countOpenEdges(const ContentMesh& mesh)
{
    const std::vector<std::uint32_t> vertex = weld(mesh);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> directed;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        for (std::size_t k = 0; k < 3; ++k)
            ++directed[{vertex[mesh.indices[i + k]], vertex[mesh.indices[i + (k + 1) % 3]]}];
    }
    int open = 0;
    for (const auto& [edge, count] : directed) {
        const auto opposite = directed.find({edge.second, edge.first});
        open += count != 1 || opposite == directed.end() || edge.first == edge.second;
    }
    return open;
}

struct Solid {
    double volume = 0;
    glm::dvec3 centre{0};
    vec3 low{1e9f}, high{-1e9f};
};

Solid measure(const ContentMesh& mesh)
{
    Solid solid;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const glm::dvec3 a(mesh.positions[mesh.indices[i]]), b(mesh.positions[mesh.indices[i + 1]]),
            c(mesh.positions[mesh.indices[i + 2]]);
        const double v = dot(a, cross(b, c)) / 6;
        solid.volume += v;
        solid.centre += v / 4 * (a + b + c);
    }
    solid.centre /= solid.volume;
    for (const vec3& p : mesh.positions) {
        solid.low = min(solid.low, p);
        solid.high = max(solid.high, p);
    }
    return solid;
}

class Shapes : public testing::TestWithParam<ContentShape> {
protected:
    const ContentMesh mesh = GetParam().make();
};

TEST_P(Shapes, AreClosed)
{
    EXPECT_EQ(countOpenEdges(mesh), 0);
}

TEST_P(Shapes, HaveUnitNormalsThatAgreeWithTheirFaces)
{
    ASSERT_EQ(mesh.positions.size(), mesh.normals.size());
    EXPECT_GT(measure(mesh).volume, 0) << "inside out";
    for (const vec3& n : mesh.normals)
        ASSERT_NEAR(length(n), 1, 1e-5f);
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        ASSERT_LT(std::max({mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]}),
                  mesh.positions.size());
        const vec3 a = mesh.positions[mesh.indices[i]], b = mesh.positions[mesh.indices[i + 1]],
                   c = mesh.positions[mesh.indices[i + 2]];
        const vec3 face = cross(b - a, c - a);
        ASSERT_GT(length(face), 1e-10f) << "triangle " << i / 3 << " has no area";
        for (std::size_t k = 0; k < 3; ++k) // half the crease angle, and some for uneven fans
            ASSERT_GT(dot(normalize(face), mesh.normals[mesh.indices[i + k]]), 0.7f)
                << "triangle " << i / 3;
    }
}

TEST_P(Shapes, AreTheSameBytesTwice)
{
    EXPECT_EQ(objText(mesh), objText(GetParam().make()));
    EXPECT_EQ(mesh.name, GetParam().name);
}

TEST_P(Shapes, FitTheBudgetAndEachOther)
{
    const Solid solid = measure(mesh);
    const vec3 size = solid.high - solid.low;
    RecordProperty("vertices", static_cast<int>(mesh.positions.size()));
    if (GetParam().name.starts_with("floor")) {
        EXPECT_EQ(solid.high.y, 0);
        EXPECT_LT(length(size - vec3(8, 0.2f, 8)), 1e-5f);
        return;
    }
    if (GetParam().name == "panel") { // stands behind the plane z = 0
        EXPECT_LT(solid.high.z, 0);
        EXPECT_LT(length(size - vec3(0.96f, 0.6f, 0.02f)), 1e-5f);
        return;
    }
    EXPECT_GE(mesh.positions.size(), 2500u);
    EXPECT_LE(mesh.positions.size(), 6000u);
    const float longest = std::max({size.x, size.y, size.z});
    EXPECT_GE(longest, 0.25f);
    EXPECT_LE(longest, 0.5f);
    EXPECT_LT(length(solid.centre), 1e-5) << "the origin is the centre of mass";
}

INSTANTIATE_TEST_SUITE_P(Content, Shapes,
                         testing::ValuesIn(contentShapes().begin(), contentShapes().end()),
                         [](const auto& shape) { return std::string(shape.param.name); });

TEST(ContentShapes, AreSortedAndFoundByName)
{
    const auto byName = [](const ContentShape& a, const ContentShape& b) {
        return a.name < b.name;
    };
    EXPECT_TRUE(std::is_sorted(contentShapes().begin(), contentShapes().end(), byName));
    EXPECT_EQ(findShape("teapot")->name, "teapot");
    EXPECT_EQ(findShape("teapo"), nullptr);
}

TEST(Floor, FollowsItsResolution)
{
    const ContentMesh floor =
        makeFloor({.width = 2, .depth = 3, .thickness = 0.5f, .cellsX = 4, .cellsZ = 7});
    EXPECT_EQ(countOpenEdges(floor), 0);
    EXPECT_NEAR(measure(floor).volume, 2 * 3 * 0.5, 1e-5);
    EXPECT_EQ(floor.indices.size() / 3,
              2u * 4 * 7 + 3u * 2 * (4 + 7)); // top; sides and bottom per edge cell
}

// The checks above see holes: a mesh without one triangle fails.
TEST(ContentShapes, AMissingTriangleIsAnOpenEdge)
{
    ContentMesh mesh = makeRoundedCube();
    mesh.indices.resize(mesh.indices.size() - 3);
    EXPECT_EQ(countOpenEdges(mesh), 3);
}

// A lathed circle is a sphere: volume, smooth normals, no crease.
TEST(MeshBuilder, LathedSphereHasRadialNormals)
{
    Profile p({0, -1}, 0.02f);
    p.arcTo({0, 0}, {1, 0}).arcTo({0, 0}, {0, 1});
    MeshBuilder builder;
    builder.addSkin(latheRings(p.points(), 200), false);
    const ContentMesh sphere = builder.finish("sphere", 30);
    EXPECT_NEAR(measure(sphere).volume, 4.0 / 3 * glm::pi<double>(), 0.005);
    EXPECT_EQ(countOpenEdges(sphere), 0);
    for (std::size_t i = 0; i < sphere.positions.size(); ++i)
        ASSERT_GT(dot(sphere.normals[i], normalize(sphere.positions[i])), 0.9995f);
}

TEST(MeshBuilder, CreasesSplitNormalsAndOnlyThem)
{
    Profile p({0, 0}, 10); // a cylinder: two caps, one wall
    p.lineTo({1, 0}).lineTo({1, 2}).lineTo({0, 2});
    MeshBuilder builder;
    builder.addSkin(latheRings(p.points(), 36), false);
    EXPECT_EQ(builder.finish("cylinder", 30).positions.size(), 2u + 4 * 36);
    EXPECT_EQ(builder.finish("cylinder", 100).positions.size(), 2u + 2 * 36);
}

// OBJ keeps every bit of every float.
TEST(Obj, ReadsBackExactly)
{
    const ContentMesh mesh = makeHexNut();
    const auto path = std::filesystem::path(testing::TempDir()) / "penumbra_content" / "nut.obj";
    ASSERT_TRUE(writeObj(path, mesh).ok());
    const auto bytes = readFile(path, 1u << 24);
    ASSERT_TRUE(bytes.ok());
    std::istringstream text(
        std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()));
    std::vector<vec3> positions, normals;
    std::size_t corners = 0;
    for (std::string line; std::getline(text, line);) {
        vec3 v;
        if (std::sscanf(line.c_str(), "v %f %f %f", &v.x, &v.y, &v.z) == 3)
            positions.push_back(v);
        else if (std::sscanf(line.c_str(), "vn %f %f %f", &v.x, &v.y, &v.z) == 3)
            normals.push_back(v);
        else if (line.starts_with("f "))
            corners += 3;
    }
    EXPECT_TRUE(positions == mesh.positions);
    EXPECT_TRUE(normals == mesh.normals);
    EXPECT_EQ(corners, mesh.indices.size());
    std::filesystem::remove_all(path.parent_path());
    EXPECT_FALSE(writeObj("/proc/none/nut.obj", mesh).ok());
}

} // namespace
} // namespace penumbra
