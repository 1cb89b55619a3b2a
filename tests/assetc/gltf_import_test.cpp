#include "assetc/import/import.h"
#include "assets/draco_mesh.h"
#include "assets/glb.h"
#include "tests/assetc/gltf_fixture.h"
#include "tests/assets/sample_assets.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

namespace penumbra {

namespace {

using nlohmann::json;

Result<ImportedMesh> importJson(const json& document)
{
    const TemporaryFolder folder;
    return importMesh(folder.write("file.gltf", document.dump()));
}

MeshAsset imported(const json& document)
{
    auto result = importJson(document);
    EXPECT_TRUE(result) << result.error().message;
    return result ? result->mesh : MeshAsset{};
}

vec3 facing(const MeshAsset& mesh, std::size_t triangle)
{
    const vec3 a = mesh.positions[mesh.indices[3 * triangle]];
    return normalize(cross(mesh.positions[mesh.indices[3 * triangle + 1]] - a,
                           mesh.positions[mesh.indices[3 * triangle + 2]] - a));
}

} // namespace

TEST(GltfImport, Square)
{
    const MeshAsset mesh = imported(squareGltf());
    ASSERT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(mesh.positions[2], (vec3{1, 1, 0}));
    EXPECT_EQ(mesh.normals[2], (vec3{0, 0, 1}));
    EXPECT_EQ(mesh.material.albedo, (vec3{0.25f, 0.5f, 0.75f}));
    EXPECT_EQ(mesh.name, "file");
}

TEST(GltfImport, NodeTransformsMultiply)
{
    json document = squareGltf();
    document["nodes"] = json::array(
        {{{"mesh", 0}, {"translation", {0, 0, 5}}},
         {{"children", {0}}, {"scale", {2, 2, 2}}, {"rotation", {0, 0.70710678, 0, 0.70710678}}}});
    document["scenes"][0]["nodes"] = {1};
    const MeshAsset mesh = imported(document);
    // (1, 1, 5) turned by 90 degrees about y is (5, 1, -1), then doubled.
    EXPECT_LT(length(mesh.positions[2] - vec3(10, 2, -2)), 1e-5f);
    EXPECT_LT(length(mesh.normals[2] - vec3(1, 0, 0)), 1e-6f);
}

// A mirror must not turn the surface inside out, and a squeeze must turn normals by the inverse
// transpose.
TEST(GltfImport, MirrorsAndSqueezesKeepNormalsOnTheirSide)
{
    json document = squareGltf();
    document["nodes"][0]["scale"] = {-1, 3, 1};
    const MeshAsset mirrored = imported(document);
    EXPECT_LT(length(facing(mirrored, 0) - mirrored.normals[0]), 1e-6f);
    EXPECT_EQ(mirrored.normals[0], (vec3{0, 0, 1}));

    document = squareGltf();
    document["nodes"][0]["matrix"] = {1, 0, 1, 0, 0, 1, 0, 0,
                                      0, 0, 1, 0, 0, 0, 0, 1}; // shear: x -> x + z
    const MeshAsset sheared = imported(document);
    EXPECT_LT(length(facing(sheared, 0) - sheared.normals[0]), 1e-6f);
}

TEST(GltfImport, StripsFansAndUnindexedVertices)
{
    json document = squareGltf();
    document["meshes"][0]["primitives"][0].erase("indices");
    document["meshes"][0]["primitives"][0]["mode"] = 6;
    EXPECT_EQ(imported(document).indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
    document["meshes"][0]["primitives"][0]["mode"] = 5;
    EXPECT_EQ(imported(document).indices, (std::vector<std::uint32_t>{0, 1, 2, 2, 1, 3}));
    document["meshes"][0]["primitives"][0]["mode"] = 1; // lines
    EXPECT_TRUE(imported(document).indices.empty());
}

TEST(GltfImport, QuantisedInterleavedAndSparse)
{
    json document = squareGltf();
    // Two vertices' worth of i16 normalised positions with stride 8, made of sparse and plain
    // parts.
    const std::string packed =
        bytesOf<std::int16_t>({0, 0, 0, 99, 32767, 0, 0, 99, 32767, 32767, 0, 99, 0, 0, 0, 99});
    const std::string sparse =
        bytesOf<std::uint8_t>({3, 0}) + bytesOf<std::int16_t>({0, -32767, 0});
    const std::string all = packed + sparse;
    document["buffers"].push_back({{"byteLength", all.size()},
                                   {"uri", "data:application/octet-stream;base64," + base64(all)}});
    document["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 32}, {"byteStride", 8}});
    document["bufferViews"].push_back({{"buffer", 1}, {"byteOffset", 32}, {"byteLength", 1}});
    document["bufferViews"].push_back({{"buffer", 1}, {"byteOffset", 34}, {"byteLength", 6}});
    document["accessors"][0] = {{"bufferView", 3},
                                {"componentType", 5122},
                                {"count", 4},
                                {"type", "VEC3"},
                                {"normalized", true},
                                {"sparse",
                                 {{"count", 1},
                                  {"indices", {{"bufferView", 4}, {"componentType", 5121}}},
                                  {"values", {{"bufferView", 5}}}}}};
    document["extensionsUsed"] = {"KHR_mesh_quantization"};
    document["extensionsRequired"] = {"KHR_mesh_quantization"};
    const MeshAsset mesh = imported(document);
    ASSERT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.positions[2], (vec3{1, 1, 0}));
    EXPECT_EQ(mesh.positions[3], (vec3{0, -1, 0}));
}

TEST(GltfImport, DracoGeometry)
{
    const MeshAsset sample = sampleMesh();
    const auto payload = *encodeDraco(sample, {});
    const std::string bytes(reinterpret_cast<const char*>(payload.data()), payload.size());
    json document = squareGltf();
    document["buffers"][0] = {{"byteLength", bytes.size()},
                              {"uri", "data:application/octet-stream;base64," + base64(bytes)}};
    document["bufferViews"] = json::array({{{"buffer", 0}, {"byteLength", bytes.size()}}});
    document["accessors"] = json::array(
        {{{"componentType", 5126}, {"count", sample.positions.size()}, {"type", "VEC3"}},
         {{"componentType", 5125}, {"count", sample.indices.size()}, {"type", "SCALAR"}},
         {{"componentType", 5126}, {"count", sample.positions.size()}, {"type", "VEC3"}}});
    json& primitive = document["meshes"][0]["primitives"][0];
    primitive["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", 0}, {"attributes", {{"POSITION", 0}, {"NORMAL", 1}}}};
    document["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    const MeshAsset mesh = imported(document);
    EXPECT_EQ(mesh.indices, sample.indices);
    ASSERT_EQ(mesh.positions.size(), sample.positions.size());
    EXPECT_LT(length(mesh.positions[9] - sample.positions[9]), 1e-4f);

    for (const json& bad : {json(-1), json(7), json(1u << 31), json("x")}) {
        primitive["extensions"]["KHR_draco_mesh_compression"]["bufferView"] = bad;
        EXPECT_FALSE(importJson(document)) << bad;
    }
}

// A vertex bound to one joint moves with the joint, not with the mesh's node; weights need not sum
// to 1.
TEST(GltfImport, SkinsAreBakedInTheStoredPose)
{
    json document = squareGltf();
    const std::string skinning =
        bytesOf<std::uint8_t>(std::vector<std::uint8_t>(16, 0)) +
        bytesOf<float>({.5f, 0, 0, 0, .5f, 0, 0, 0, .5f, 0, 0, 0, .5f, 0, 0, 0});
    document["buffers"].push_back(
        {{"byteLength", skinning.size()},
         {"uri", "data:application/octet-stream;base64," + base64(skinning)}});
    document["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 16}});
    document["bufferViews"].push_back({{"buffer", 1}, {"byteOffset", 16}, {"byteLength", 64}});
    document["accessors"].push_back(
        {{"bufferView", 3}, {"componentType", 5121}, {"count", 4}, {"type", "VEC4"}});
    document["accessors"].push_back(
        {{"bufferView", 4}, {"componentType", 5126}, {"count", 4}, {"type", "VEC4"}});
    document["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = 3;
    document["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = 4;
    document["nodes"] = json::array(
        {{{"mesh", 0}, {"skin", 0}, {"translation", {100, 0, 0}}}, {{"translation", {0, 7, 0}}}});
    document["scenes"][0]["nodes"] = {0, 1};
    document["skins"] = json::array({{{"joints", {1}}}});
    const auto result = importJson(document);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->mesh.positions[1], (vec3{1, 7, 0}));
    EXPECT_EQ(result->warnings.size(), 1u);
}

TEST(GltfImport, MorphTargetsUseDefaultWeights)
{
    json document = squareGltf();
    document["meshes"][0]["primitives"][0]["targets"] =
        json::array({{{"POSITION", 2}}}); // the normals as offsets
    document["meshes"][0]["weights"] = {0.5};
    EXPECT_EQ(imported(document).positions[1], (vec3{1, 0, 0.5f}));
    document["nodes"][0]["weights"] = {2};
    EXPECT_EQ(imported(document).positions[1], (vec3{1, 0, 2}));
}

TEST(GltfImport, LargestPrimitiveGivesTheAlbedo)
{
    json document = squareGltf();
    document["materials"].push_back(
        {{"pbrMetallicRoughness", {{"baseColorFactor", {1, 0, 0, 1}}}}});
    json small = document["meshes"][0];
    small["primitives"][0]["material"] = 1;
    document["meshes"].push_back(small);
    document["nodes"].push_back({{"mesh", 1}, {"scale", {0.5, 0.5, 0.5}}});
    document["scenes"][0]["nodes"] = {1, 0};
    const MeshAsset mesh = imported(document);
    EXPECT_EQ(mesh.positions.size(), 8u);
    EXPECT_EQ(mesh.material.albedo, (vec3{0.25f, 0.5f, 0.75f}));
}

TEST(GltfImport, OnlyTheDefaultSceneCounts)
{
    json document = squareGltf();
    document["nodes"].push_back({{"mesh", 0}});
    document["scenes"] = json::array({{{"nodes", {0, 1}}}, {{"nodes", {1}}}});
    document["scene"] = 1;
    EXPECT_EQ(imported(document).positions.size(), 4u);
}

TEST(GltfImport, ImagesAreNeitherReadNorDecoded)
{
    json document = squareGltf();
    document["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 48}});
    document["images"] =
        json::array({{{"uri", "missing.png"}}, {{"bufferView", 3}, {"mimeType", "image/png"}}});
    document["textures"] = json::array({{{"source", 0}}});
    EXPECT_EQ(imported(document).positions.size(), 4u);
}

TEST(GltfImport, BinaryFileAndBufferBesideIt)
{
    const TemporaryFolder folder;
    json document = squareGltf();
    const MeshAsset sample = imported(document);
    const auto square = json::parse(document.dump());
    const std::string all = bytesOf<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}) +
                            bytesOf<std::uint16_t>({0, 1, 2, 0, 2, 3}) +
                            bytesOf<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
    document["buffers"][0].erase("uri");
    const auto glb = *writeGlb(document.dump(), std::as_bytes(std::span(all)));
    ASSERT_TRUE(writeFile(folder / "a.glb", std::span<const std::byte>(glb)));
    const auto binary = importMesh(folder / "a.glb");
    ASSERT_TRUE(binary) << binary.error().message;
    EXPECT_EQ(binary->mesh.positions, sample.positions);

    folder.write("data/the square.bin", all);
    document["buffers"][0]["uri"] = "data/the%20square.bin";
    const auto beside = importMesh(folder.write("b.gltf", document.dump()));
    ASSERT_TRUE(beside) << beside.error().message;
    EXPECT_EQ(beside->mesh.positions, sample.positions);
}

} // namespace penumbra
