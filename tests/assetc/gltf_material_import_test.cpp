// Materials, textures, colours, lights and instances on their way in.
#include "assetc/import/clean.h"
#include "assetc/import/import.h"
#include "tests/assetc/gltf_fixture.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <random>

namespace penumbra {

namespace {

using nlohmann::json;

Result<ImportedMesh> importJson(const json& document)
{
    const TemporaryFolder folder;
    return importMesh(folder.write("file.gltf", document.dump()));
}

MeshAsset cleaned(const json& document)
{
    auto result = importJson(document);
    EXPECT_TRUE(result) << result.error().message;
    if (!result)
        return {};
    const auto report = cleanMesh(result->mesh);
    EXPECT_TRUE(report) << report.error().message;
    return result->mesh;
}

template <class Edit>
std::string refusalAfter(json document, Edit edit)
{
    edit(document);
    const auto result = importJson(document);
    return result ? "" : result.error().message;
}

std::string bytesOfImage(const MeshImage& image)
{
    return {reinterpret_cast<const char*>(image.bytes.data()), image.bytes.size()};
}

// Two squares of two materials that share an edge.
json twoMaterials()
{
    json document = squareGltf();
    document["materials"].push_back({{"pbrMetallicRoughness", {{"metallicFactor", 0.5}}}});
    json second = document["meshes"][0]["primitives"][0];
    second["material"] = 1;
    document["meshes"][0]["primitives"].push_back(second);
    return document;
}

} // namespace

TEST(GltfMaterials, TexturesAreKeptWithTheirImages)
{
    const MeshAsset mesh = cleaned(texturedGltf());
    ASSERT_EQ(mesh.materials.size(), 1u);
    const SurfaceMaterial& material = mesh.materials[0];
    EXPECT_EQ(material.name, "paint");
    EXPECT_EQ(material.albedo, (vec3{0.25f, 0.5f, 0.75f}));
    EXPECT_EQ(material.roughness, 0.5f);
    EXPECT_EQ(material.metallic, 1);
    EXPECT_EQ(material.normalScale, 0.25f);
    ASSERT_TRUE(material.textures[kBaseColorTexture] && material.textures[kNormalTexture]);
    EXPECT_EQ(material.textures[kBaseColorTexture]->wrapS, 33071u);
    EXPECT_EQ(material.textures[kBaseColorTexture]->wrapT, 10497u);
    ASSERT_EQ(mesh.images.size(), 2u); // the unused one is not even opened
    EXPECT_EQ(bytesOfImage(mesh.images[material.textures[kBaseColorTexture]->image]), fakePng());
    EXPECT_EQ(bytesOfImage(mesh.images[material.textures[kNormalTexture]->image]), fakeJpeg());
    ASSERT_EQ(mesh.texcoords0.size(), 4u);
    EXPECT_EQ(mesh.texcoords0[2], (vec2{1, 1}));
    EXPECT_TRUE(mesh.texcoords1.empty()); // no texture uses it
}

TEST(GltfMaterials, EqualImagesAreStoredOnce)
{
    json document = texturedGltf();
    document["images"][1] = {{"uri", dataUri("image/png", fakePng())}};
    EXPECT_EQ(cleaned(document).images.size(), 1u);
}

TEST(GltfMaterials, ImageBesideTheFileAndItsAbsence)
{
    const TemporaryFolder folder;
    json document = texturedGltf();
    document["images"][0] = {{"uri", "paint%20a.png"}};
    folder.write("paint a.png", fakePng('z'));
    const auto path = folder.write("file.gltf", document.dump());
    const auto result = importMesh(path);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(bytesOfImage(result->mesh.images[0]), fakePng('z'));
    EXPECT_TRUE(result->warnings.empty());

    for (const char* bad : {"missing.png", "../paint.png", "/etc/hostname", "http://a.org/b.png",
                            "data:image/png;base64,AAAA", "file.gltf"}) {
        document["images"][0] = {{"uri", bad}};
        const auto left = importMesh(folder.write("file.gltf", document.dump()));
        ASSERT_TRUE(left) << left.error().message;
        ASSERT_EQ(left->warnings.size(), 1u) << bad;
        EXPECT_NE(left->warnings[0].find("images[0]"), std::string::npos) << left->warnings[0];
        EXPECT_EQ(left->mesh.images.size(), 1u);
        EXPECT_FALSE(left->mesh.materials[0].textures[kBaseColorTexture]);
    }
}

TEST(GltfMaterials, BrokenReferencesAreRefused)
{
    const auto refuses = [](auto&& edit) { return !refusalAfter(texturedGltf(), edit).empty(); };
    EXPECT_FALSE(refuses([](json&) {}));
    for (const json& bad : {json(-1), json(7), json(1ull << 40), json("x")}) {
        EXPECT_TRUE(refuses([&](json& d) { d["textures"][0]["source"] = bad; })) << bad;
        EXPECT_TRUE(refuses([&](json& d) { d["textures"][0]["sampler"] = bad; })) << bad;
        EXPECT_TRUE(refuses([&](json& d) { d["images"][0]["bufferView"] = bad; })) << bad;
        EXPECT_TRUE(refuses([&](json& d) { d["materials"][0]["normalTexture"]["index"] = bad; }))
            << bad;
    }
    EXPECT_TRUE(refuses([](json& d) { d["samplers"][0]["wrapS"] = 1; }));
    EXPECT_TRUE(refuses([](json& d) { d["materials"][0]["alphaMode"] = "GLASS"; }));
    EXPECT_TRUE(refuses([](json& d) { d["images"] = 3; }));
    EXPECT_TRUE(refuses([](json& d) { d["accessors"][3]["count"] = 3; })); // TEXCOORD_0
    EXPECT_TRUE(refuses([](json& d) { d["accessors"][3]["type"] = "VEC3"; }));
}

TEST(GltfMaterials, MaterialsBecomeSubmeshesAndSplitVertices)
{
    const MeshAsset mesh = cleaned(twoMaterials());
    ASSERT_EQ(mesh.submeshes.size(), 2u);
    EXPECT_EQ(mesh.submeshes[0], (Submesh{0, 6, 0, 4, 0}));
    EXPECT_EQ(mesh.submeshes[1], (Submesh{6, 6, 4, 4, 1})); // the same corners once more
    EXPECT_EQ(mesh.materials[1].metallic, 0.5f);
}

TEST(GltfMaterials, MaterialsAlikeAreOneAndUnusedOnesGo)
{
    json document = twoMaterials();
    document["materials"][1] = document["materials"][0];
    document["materials"][1]["name"] = "copy";
    document["materials"].push_back({{"name", "unused"}});
    const MeshAsset mesh = cleaned(document);
    EXPECT_EQ(mesh.materials.size(), 1u);
    EXPECT_EQ(mesh.submeshes.size(), 1u);
    EXPECT_EQ(mesh.positions.size(), 4u);
}

TEST(GltfMaterials, PrimitiveWithoutAMaterial)
{
    json document = twoMaterials();
    document["meshes"][0]["primitives"][1].erase("material");
    const MeshAsset mesh = cleaned(document);
    ASSERT_EQ(mesh.materials.size(), 2u);
    EXPECT_EQ(mesh.materials[1].albedo, vec3(0.8f));
}

TEST(GltfMaterials, VertexColours)
{
    const auto colors = [](const auto& values, int componentType, const char* type,
                           bool normalized) {
        json document = squareGltf();
        document["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
            addAccessor(document, values, componentType, type, 4, normalized);
        return cleaned(document).colors;
    };
    const std::vector<float> floats = {1, 0, 0.5f, 2, -1, 0, 0, 0, 0, 1, 1, 1};
    const auto three = colors(floats, 5126, "VEC3", false);
    ASSERT_EQ(three.size(), 4u);
    EXPECT_EQ(three[0], (VertexColor{255, 0, 128, 255}));
    EXPECT_EQ(three[1], (VertexColor{255, 0, 0, 255})); // clamped
    const std::vector<std::uint8_t> bytes = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};
    EXPECT_EQ(colors(bytes, 5121, "VEC4", true)[3], (VertexColor{13, 14, 15, 16}));
    std::vector<std::uint16_t> shorts(16, 65535);
    EXPECT_TRUE(colors(shorts, 5123, "VEC4", true).empty()); // all white: nothing to keep
    shorts[0] = 257 * 7;
    EXPECT_EQ(colors(shorts, 5123, "VEC4", true)[0], (VertexColor{7, 255, 255, 255}));
}

TEST(GltfMaterials, IndicesOfEveryWidth)
{
    const auto indices = [](const auto& values, int componentType) {
        json document = squareGltf();
        document["meshes"][0]["primitives"][0]["indices"] =
            addAccessor(document, values, componentType, "SCALAR", 6);
        return cleaned(document).indices;
    };
    const std::vector<std::uint32_t> expected = {0, 1, 2, 0, 2, 3};
    EXPECT_EQ(indices(std::vector<std::uint8_t>{0, 1, 2, 0, 2, 3}, 5121), expected);
    EXPECT_EQ(indices(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, 5123), expected);
    EXPECT_EQ(indices(expected, 5125), expected);
}

TEST(GltfInstances, EveryInstanceCounts)
{
    json document = squareGltf();
    const std::size_t translations =
        addAccessor<float>(document, {0, 0, 0, 0, 0, 5, 0, 0, 9}, 5126, "VEC3", 3);
    const std::size_t turns = addAccessor<std::int16_t>(
        document, {0, 0, 0, 32767, 0, 0, 0, 32767, 0, 0, 32767, 0}, 5122, "VEC4", 3, true);
    document["nodes"][0]["scale"] = {2, 2, 2};
    document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", translations}, {"ROTATION", turns}};
    document["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    const MeshAsset mesh = cleaned(document);
    ASSERT_EQ(mesh.positions.size(), 12u);
    EXPECT_EQ(mesh.positions[2], (vec3{2, 2, 0}));
    EXPECT_EQ(mesh.positions[6], (vec3{2, 2, 10}));
    EXPECT_LT(length(mesh.positions[10] - vec3(-2, -2, 18)), 1e-5f); // half a turn about z

    const auto refuses = [&](auto&& edit) {
        return !refusalAfter(document, [&](json& d) {
                    edit(d["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]);
                }).empty();
    };
    EXPECT_FALSE(refuses([](json&) {}));
    for (const json& bad : {json(-1), json(99), json("x"), json(0)}) // 0: four, not three
        EXPECT_TRUE(refuses([&](json& a) { a["TRANSLATION"] = bad; })) << bad;
    EXPECT_TRUE(refuses([](json& a) { a = json::object(); }));
    EXPECT_TRUE(refuses([](json& a) { a = 4; }));
    EXPECT_TRUE(refuses([&](json& a) { a["SCALE"] = turns; }));
    EXPECT_NE(
        refusalAfter(document,
                     [](json& d) {
                         d["accessors"].push_back(
                             {{"componentType", 5126}, {"count", 10000000}, {"type", "VEC3"}});
                         d["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
                             {"SCALE", d["accessors"].size() - 1}};
                     })
            .find("instances"),
        std::string::npos);
}

TEST(GltfLights, ArePlacedInTheWorld)
{
    json document = squareGltf();
    document["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"},
         {"name", "lamp"},
         {"intensity", 40},
         {"range", 3},
         {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.4}}}},
        {{"type", "directional"}, {"color", {1, 0.5, 0}}}};
    document["nodes"].push_back({{"translation", {1, 2, 3}},
                                 {"scale", {2, 2, 2}},
                                 {"rotation", {0, 1, 0, 0}},
                                 {"children", {2}},
                                 {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    document["nodes"].push_back({{"name", "sun"},
                                 {"translation", {0, 0, 1}},
                                 {"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}});
    document["scenes"][0]["nodes"] = {0, 1};
    const auto result = importJson(document);
    ASSERT_TRUE(result) << result.error().message;
    ASSERT_EQ(result->mesh.lights.size(), 2u);
    const MeshLight& lamp = result->mesh.lights[0];
    EXPECT_EQ(lamp.type, LightType::Spot);
    EXPECT_EQ(lamp.name, "lamp");
    EXPECT_EQ(lamp.position, (vec3{1, 2, 3}));
    EXPECT_LT(length(lamp.direction - vec3(0, 0, 1)), 1e-6f);
    EXPECT_EQ(lamp.outerCone, 0.4f);
    const MeshLight& sun = result->mesh.lights[1];
    EXPECT_EQ(sun.name, "sun");
    EXPECT_LT(length(sun.position - vec3(1, 2, 1)), 1e-6f);

    const auto refuses = [&](auto&& edit) { return !refusalAfter(document, edit).empty(); };
    EXPECT_TRUE(
        refuses([](json& d) { d["nodes"][2]["extensions"]["KHR_lights_punctual"]["light"] = 2; }));
    EXPECT_TRUE(refuses(
        [](json& d) { d["extensions"]["KHR_lights_punctual"]["lights"][0]["type"] = "laser"; }));
    EXPECT_TRUE(refuses([](json& d) {
        d["extensions"]["KHR_lights_punctual"]["lights"][0]["spot"]["innerConeAngle"] = 0.4;
    }));
    EXPECT_TRUE(refuses(
        [](json& d) { d["extensions"]["KHR_lights_punctual"]["lights"][0]["intensity"] = -1; }));
}

// Textures, lights, instances and a hierarchy at once, under random damage.
TEST(GltfMaterials, MutatedTextNeverCrashes)
{
    json document = texturedGltf();
    document["nodes"] = armGltf()["nodes"];
    document["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    document["nodes"][2]["extensions"]["KHR_lights_punctual"]["light"] = 0;
    document["nodes"][3]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", 2}};
    const std::string good = document.dump();
    const TemporaryFolder folder;
    ASSERT_TRUE(importMesh(folder.write("a.gltf", good)));
    std::mt19937 random(11);
    for (int round = 0; round < 2000; ++round) {
        std::string text = good;
        for (int k = 0; k < 3; ++k)
            text[random() % text.size()] = static_cast<char>(
                random() % 3 == 0 ? random() : "0123456789-{}[]\",:eE"[random() % 21]);
        const auto path = folder.write("a.gltf", text);
        if (auto mesh = importMesh(path))
            static_cast<void>(cleanMesh(mesh->mesh));
        static_cast<void>(importScene(path));
    }
}

TEST(ObjMaterials, SubmeshesTexturesAndFlippedCoordinates)
{
    const TemporaryFolder folder;
    folder.write("a.mtl", "newmtl red\nKd 1 0 0\nnewmtl photo\nKd 1 1 1\nmap_Kd photo.jpg\n"
                          "newmtl lost\nKd 0 1 0\nmap_Kd ../x.png\n");
    folder.write("photo.jpg", fakeJpeg());
    auto result = importMesh(folder.write(
        "a.obj",
        "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 2 0\nvt 0 0\nvt 1 0.25\n"
        "usemtl red\nf 1/1 2/1 3/1\nusemtl photo\nf 1/1 3/2 4/9\nusemtl red\nf 3/1 5/1 4/1\n"));
    ASSERT_TRUE(result) << result.error().message;
    ASSERT_EQ(result->warnings.size(), 1u);
    EXPECT_NE(result->warnings[0].find("lost"), std::string::npos);
    ASSERT_TRUE(cleanMesh(result->mesh));
    const MeshAsset& mesh = result->mesh;
    ASSERT_EQ(mesh.submeshes.size(), 2u);
    EXPECT_EQ(mesh.submeshes[0].indexCount, 6u);
    EXPECT_EQ(mesh.materials[0].albedo, (vec3{1, 0, 0}));
    EXPECT_EQ(mesh.materials[1].textures[kBaseColorTexture]->image, 0u);
    EXPECT_EQ(mesh.images.size(), 1u);
    EXPECT_EQ(mesh.texcoords0[mesh.indices[7]], (vec2{1, 0.75f}));
}

} // namespace penumbra
