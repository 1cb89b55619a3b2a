#include "assets/mesh_codec.h"

#include "assets/glb.h"
#include "tests/assets/sample_assets.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace penumbra {

namespace {

float boundsSide(const MeshAsset& mesh)
{
    const vec3 size = mesh.boundsMax - mesh.boundsMin;
    return std::max({size.x, size.y, size.z});
}

} // namespace

TEST(MeshCodec, RoundTripKeepsOrderAndBits)
{
    const MeshAsset mesh = sampleAsset(24);
    const auto bytes = encodeMeshAsset(mesh);
    ASSERT_TRUE(bytes) << bytes.error().message;
    const auto decoded = decodeMeshAsset(*bytes);
    ASSERT_TRUE(decoded) << decoded.error().message;

    EXPECT_EQ(decoded->name, mesh.name);
    EXPECT_EQ(decoded->indices, mesh.indices);               // same triangles, same order
    EXPECT_EQ(decoded->selfVisibility, mesh.selfVisibility); // random, so any reordering shows
    ASSERT_EQ(decoded->positions.size(), mesh.positions.size());
    const float step = boundsSide(mesh) / 65535.0f; // 16 bits
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(decoded->positions[i][axis], mesh.positions[i][axis], 0.51f * step)
                << "vertex " << i;
        EXPECT_GT(dot(decoded->normals[i], mesh.normals[i]), 1 - 2e-6f)
            << "vertex " << i; // 12 bits
    }
    EXPECT_EQ(decoded->material.albedo, mesh.material.albedo);
    EXPECT_EQ(decoded->material.glossFraction, mesh.material.glossFraction);
    EXPECT_EQ(decoded->material.glossExponent, mesh.material.glossExponent);
    EXPECT_EQ(decoded->clusters.size(), (mesh.positions.size() + 63) / 64);
}

TEST(MeshCodec, RoundTripKeepsTheFieldExactly)
{
    MeshAsset mesh = sampleAsset();
    mesh.field->inscribed = {0.2f, -0.1f, 0.3f, 0.5f};
    const auto decoded = decodeMeshAsset(*encodeMeshAsset(mesh));
    ASSERT_TRUE(decoded) << decoded.error().message;
    ASSERT_TRUE(decoded->field);
    EXPECT_EQ(decoded->field->kind, mesh.field->kind);
    EXPECT_EQ(decoded->field->channels, mesh.field->channels);
    EXPECT_EQ(decoded->field->frames, mesh.field->frames);
    EXPECT_EQ(decoded->field->center, mesh.field->center);
    EXPECT_EQ(decoded->field->radius, mesh.field->radius);
    EXPECT_EQ(decoded->field->innerRadius, mesh.field->innerRadius);
    EXPECT_EQ(decoded->field->outerRadius, mesh.field->outerRadius);
    EXPECT_EQ(decoded->field->bandScale, mesh.field->bandScale);
    EXPECT_EQ(decoded->field->shellSides, mesh.field->shellSides);
    EXPECT_EQ(decoded->field->directions, mesh.field->directions);
    EXPECT_EQ(decoded->field->inscribed, mesh.field->inscribed);
    EXPECT_EQ(decoded->field->texels, mesh.field->texels);
}

TEST(MeshCodec, RadianceFieldOfThreeChannelsAndTwoFrames)
{
    MeshAsset mesh = sampleAsset();
    mesh.field->kind = FieldKind::Radiance;
    mesh.field->channels = 3;
    mesh.field->frames = 2;
    mesh.field->texels.resize(fieldTexelBytes(*mesh.field), 200);
    const auto decoded = decodeMeshAsset(*encodeMeshAsset(mesh));
    ASSERT_TRUE(decoded) << decoded.error().message;
    EXPECT_EQ(decoded->field->kind, FieldKind::Radiance);
    EXPECT_EQ(decoded->field->texels, mesh.field->texels);
}

TEST(MeshCodec, MeshWithoutField)
{
    const auto decoded = decodeMeshAsset(*encodeMeshAsset(sampleMesh()));
    ASSERT_TRUE(decoded) << decoded.error().message;
    EXPECT_FALSE(decoded->field);
}

TEST(MeshCodec, EncodingIsDeterministic)
{
    EXPECT_EQ(*encodeMeshAsset(sampleAsset(16)), *encodeMeshAsset(sampleAsset(16)));
}

// What is baked is what is shipped: encoding a quantised mesh moves nothing by more than rounding.
TEST(MeshCodec, QuantizedMeshIsAFixedPoint)
{
    MeshAsset mesh = sampleMesh(24);
    ASSERT_TRUE(quantizeMesh(mesh));
    const auto decoded = decodeMeshAsset(*encodeMeshAsset(mesh));
    ASSERT_TRUE(decoded);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        EXPECT_LT(length(decoded->positions[i] - mesh.positions[i]), 1e-6f * boundsSide(mesh));
        EXPECT_LT(length(decoded->normals[i] - mesh.normals[i]), 1e-6f);
    }
}

TEST(MeshCodec, QuantizeLeavesSelfVisibilityAlone)
{
    MeshAsset mesh = sampleMesh();
    const auto before = mesh.selfVisibility;
    ASSERT_TRUE(quantizeMesh(mesh));
    EXPECT_EQ(mesh.selfVisibility, before);
    mesh.selfVisibility.clear();
    ASSERT_TRUE(quantizeMesh(mesh));
    EXPECT_TRUE(mesh.selfVisibility.empty());
}

// The promises of design section 3 that other programs rely on.
TEST(MeshCodec, FileIsGltfWithTheTwoExtensions)
{
    const auto bytes = encodeMeshAsset(sampleAsset());
    const auto glb = readGlb(*bytes);
    ASSERT_TRUE(glb);
    const auto document = nlohmann::json::parse(glb->json);
    EXPECT_EQ(document["asset"]["version"], "2.0");
    EXPECT_EQ(document["extensionsRequired"],
              nlohmann::json::array({"KHR_draco_mesh_compression"}));
    const auto& extension = document["meshes"][0]["extensions"]["PENUMBRA_shadow_field"];
    EXPECT_EQ(extension["version"], "1.3");
    EXPECT_EQ(extension["basis"], "sh4");
    EXPECT_EQ(extension["byteLength"], 34 * 16);
    const auto& attributes = document["meshes"][0]["primitives"][0]["attributes"];
    for (const char* name :
         {"POSITION", "NORMAL", "_SELFVIS_0", "_SELFVIS_1", "_SELFVIS_2", "_SELFVIS_3"})
        EXPECT_TRUE(attributes.contains(name)) << name;
}

TEST(MeshCodec, NameThatIsNotUtf8IsMended)
{
    MeshAsset mesh = sampleMesh();
    mesh.name = "b\xff";
    const auto decoded = decodeMeshAsset(*encodeMeshAsset(mesh));
    ASSERT_TRUE(decoded);
    EXPECT_EQ(decoded->name, "b\xef\xbf\xbd");
}

TEST(MeshCodec, EncodeRefusesWhatDecodeWouldRefuse)
{
    const auto refuses = [](auto&& spoil) {
        MeshAsset mesh = sampleAsset();
        spoil(mesh);
        return !encodeMeshAsset(mesh);
    };
    EXPECT_TRUE(refuses([](MeshAsset& m) { m.indices[4] = 100000; }));
    EXPECT_TRUE(refuses([](MeshAsset& m) { m.indices.pop_back(); }));
    EXPECT_TRUE(refuses([](MeshAsset& m) { m.indices.clear(); }));
    EXPECT_TRUE(refuses([](MeshAsset& m) { m.positions[3].y = std::nanf(""); }));
    EXPECT_TRUE(refuses([](MeshAsset& m) { m.positions[3].x = 1e30f; }));
    EXPECT_TRUE(refuses([](MeshAsset& m) { m.normals[3] = vec3{0}; }));
    EXPECT_TRUE(refuses([](MeshAsset& m) { m.normals.pop_back(); }));
    EXPECT_TRUE(refuses([](MeshAsset& m) { m.material.albedo.g = 1.5f; }));
    EXPECT_TRUE(refuses([](MeshAsset& m) { m.material.glossFraction = -1; }));
    EXPECT_TRUE(refuses([](MeshAsset& m) { m.material.glossExponent = INFINITY; }));
    EXPECT_TRUE(refuses([](MeshAsset& m) { m.name.assign(300, 'x'); }));
    EXPECT_TRUE(refuses([](MeshAsset& m) { m.field->texels.pop_back(); }));
    EXPECT_FALSE(encodeMeshAsset(sampleAsset(), {.positionBits = 40}));
    EXPECT_FALSE(encodeMeshAsset(sampleAsset(), {.normalBits = 1}));
}

} // namespace penumbra
