// What format 1.2 added: submeshes, materials with textures, images, lights, LODs.
#include "assets/glb.h"
#include "assets/mesh_codec.h"
#include "tests/assets/sample_assets.h"
#include "tests/assets/version_1_1.h"

#include <charconv>
#include <cstring>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace penumbra {

namespace {

using nlohmann::json;

std::vector<std::byte> fromHex(std::string_view hex)
{
    std::vector<std::byte> bytes(hex.size() / 2);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        unsigned value = 0;
        std::from_chars(&hex[2 * i], &hex[2 * i] + 2, value, 16);
        bytes[i] = static_cast<std::byte>(value);
    }
    return bytes;
}

// The message of the error after `edit` has changed the JSON of sampleScene(); "" where it decodes.
template <class Edit>
std::string errorAfter(Edit edit)
{
    static const std::vector<std::byte> bytes = *encodeMeshAsset(sampleScene());
    const auto glb = *readGlb(bytes);
    json document = json::parse(glb.json);
    edit(document);
    const auto edited = *writeGlb(document.dump(), glb.bin);
    const std::vector<std::byte> exact(edited); // of its exact size, for asan
    const auto decoded = decodeMeshAsset(exact);
    return decoded ? "" : decoded.error().message;
}

void expectSameGeometry(const MeshGeometry& a, const MeshGeometry& b)
{
    EXPECT_EQ(a.indices, b.indices);
    EXPECT_EQ(a.selfVisibility, b.selfVisibility);
    EXPECT_EQ(a.colors, b.colors);
    EXPECT_EQ(a.submeshes, b.submeshes);
    ASSERT_EQ(a.positions.size(), b.positions.size());
    ASSERT_EQ(a.texcoords0.size(), b.texcoords0.size());
    ASSERT_EQ(a.texcoords1.size(), b.texcoords1.size());
    for (std::size_t i = 0; i < a.positions.size(); ++i) {
        EXPECT_LT(length(a.positions[i] - b.positions[i]), 1e-4f) << i;
        EXPECT_LT(length(a.texcoords0[i] - b.texcoords0[i]), 1e-4f) << i;
        EXPECT_LT(length(a.texcoords1[i] - b.texcoords1[i]), 1e-3f) << i; // over 18 repeats
    }
}

} // namespace

TEST(MeshCodecScene, RoundTripKeepsEverything)
{
    const MeshAsset mesh = sampleScene();
    const auto bytes = encodeMeshAsset(mesh);
    ASSERT_TRUE(bytes) << bytes.error().message;
    const auto decoded = decodeMeshAsset(*bytes);
    ASSERT_TRUE(decoded) << decoded.error().message;
    expectSameGeometry(*decoded, mesh);
    EXPECT_EQ(decoded->materials, mesh.materials);
    EXPECT_EQ(decoded->images, mesh.images);
    EXPECT_EQ(decoded->clusters.size(), (mesh.positions.size() + 63) / 64);
    EXPECT_EQ(decoded->material, MeshMaterial(mesh.materials[1])); // the larger sphere's
    ASSERT_EQ(decoded->lights.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_LT(length(decoded->lights[i].direction - mesh.lights[i].direction), 1e-6f) << i;
        MeshLight light = decoded->lights[i];
        light.direction = mesh.lights[i].direction;
        EXPECT_EQ(light, mesh.lights[i]) << i;
    }
    ASSERT_EQ(decoded->lods.size(), 1u);
    EXPECT_EQ(decoded->lods[0].error, 0.125f);
    EXPECT_FALSE(decoded->lods[0].clusters.empty());
    expectSameGeometry(decoded->lods[0], mesh.lods[0]);
    ASSERT_TRUE(decoded->field);
    EXPECT_EQ(decoded->field->texels, mesh.field->texels);
}

// Submeshes and LODs share a lattice: a point that two of them have stays one point.
TEST(MeshCodecScene, SubmeshesAndLodsMeetWithoutCracks)
{
    MeshAsset mesh = sampleScene();
    const vec3 shared = mesh.positions.back();
    mesh.positions[3] = shared;
    ASSERT_TRUE(quantizeMesh(mesh));
    EXPECT_EQ(mesh.positions[3], mesh.positions.back());
    mesh.lods[0].positions = mesh.positions;
    const auto decoded = decodeMeshAsset(*encodeMeshAsset(mesh));
    ASSERT_TRUE(decoded);
    EXPECT_EQ(decoded->positions[3], decoded->positions.back());
    EXPECT_EQ(decoded->lods[0].positions, decoded->positions);
}

TEST(MeshCodecScene, Version11IsStillRead)
{
    const auto bytes = fromHex(kVersion11Asset);
    const auto decoded = decodeMeshAsset(bytes);
    ASSERT_TRUE(decoded) << decoded.error().message;
    EXPECT_EQ(decoded->positions.size(), 4u);
    EXPECT_EQ(decoded->material.albedo, vec3(0.8f));
    ASSERT_EQ(decoded->submeshes.size(), 1u);
    EXPECT_EQ(decoded->submeshes[0], (Submesh{0, 6, 0, 4, 0}));
    EXPECT_EQ(decoded->materials.size(), 1u);
    EXPECT_TRUE(decoded->images.empty() && decoded->lights.empty() && decoded->lods.empty());
    ASSERT_TRUE(decoded->field);
    EXPECT_EQ(decoded->field->shellSides, (std::vector<std::uint16_t>{3, 3}));
}

TEST(MeshCodecScene, ExtensionsAreNamedOnlyWhereUsed)
{
    const auto used = [](const MeshAsset& mesh) {
        return json::parse(readGlb(*encodeMeshAsset(mesh))->json)["extensionsUsed"].size();
    };
    EXPECT_EQ(used(sampleMesh()), 2u);
    EXPECT_EQ(used(sampleScene()), 5u); // lights, LODs, texture transforms
}

TEST(MeshCodecScene, EveryTruncationIsRefused)
{
    const auto bytes = *encodeMeshAsset(sampleScene());
    for (std::size_t size = 0; size < bytes.size(); size += 3) {
        const std::vector<std::byte> cut(bytes.begin(),
                                         bytes.begin() + static_cast<std::ptrdiff_t>(size));
        EXPECT_FALSE(decodeMeshAsset(cut)) << size;
    }
}

TEST(MeshCodecScene, DamagedPayloadsAreNoticed)
{
    const auto bytes = *encodeMeshAsset(sampleScene());
    const auto glb = *readGlb(bytes);
    const json document = json::parse(glb.json);
    for (const json& view : document["bufferViews"]) {
        const std::size_t first = view["byteOffset"], size = view["byteLength"];
        for (std::size_t at = first; at < first + size; at += 41) {
            std::vector<std::byte> damaged(glb.bin.begin(), glb.bin.end());
            damaged[at] ^= std::byte{4};
            EXPECT_FALSE(decodeMeshAsset(*writeGlb(std::string(glb.json), damaged))) << at;
        }
    }
}

TEST(MeshCodecScene, HostileSubmeshes)
{
    EXPECT_EQ(errorAfter([](json&) {}), "");
    const auto refuses = [](auto&& edit) {
        return !errorAfter([&](json& d) { edit(d["meshes"][0]["primitives"]); }).empty();
    };
    EXPECT_TRUE(refuses([](json& p) { p = json::array(); }));
    EXPECT_TRUE(refuses([](json& p) { p = 3; }));
    EXPECT_TRUE(refuses([](json& p) { p.erase(1); })); // checksum of both
    EXPECT_TRUE(refuses([](json& p) { p.push_back(p[0]); }));
    EXPECT_TRUE(refuses([](json& p) { std::swap(p[0], p[1]); }));
    for (const json& bad : {json(-1), json(2), json(1ull << 40), json("x")})
        EXPECT_TRUE(refuses([&](json& p) { p[1]["material"] = bad; })) << bad;
    for (const char* name : {"TEXCOORD_0", "COLOR_0"}) {
        EXPECT_TRUE(refuses([&](json& p) {
            p[1]["extensions"]["KHR_draco_mesh_compression"]["attributes"].erase(name);
        })) << name;
        for (const json& bad : {json(-1), json(0), json(77), json("x")})
            EXPECT_TRUE(refuses([&](json& p) {
                p[0]["extensions"]["KHR_draco_mesh_compression"]["attributes"][name] = bad;
            })) << name
                << bad;
    }
    // Many submeshes that claim the largest mesh each.
    EXPECT_NE(errorAfter([](json& d) {
                  d["accessors"][0]["count"] = kMaxMeshVertices;
                  json& primitives = d["meshes"][0]["primitives"];
                  primitives = json::array({primitives[0], primitives[0], primitives[0]});
              }).find("in all"),
              std::string::npos);
}

TEST(MeshCodecScene, HostileMaterialsAndTextures)
{
    const auto refuses = [](auto&& edit) { return !errorAfter(edit).empty(); };
    for (const char* key : {"index", "texCoord"})
        for (const json& bad : {json(-1), json(99), json(1ull << 40), json("x"), json::object()})
            EXPECT_TRUE(refuses([&](json& d) { d["materials"][1]["normalTexture"][key] = bad; }))
                << key << bad;
    for (const json& bad : {json(-1), json(99), json("x")}) {
        EXPECT_TRUE(refuses([&](json& d) { d["textures"][0]["source"] = bad; })) << bad;
        EXPECT_TRUE(refuses([&](json& d) { d["textures"][0]["sampler"] = bad; })) << bad;
        EXPECT_TRUE(refuses([&](json& d) { d["samplers"][0]["wrapS"] = bad; })) << bad;
        EXPECT_TRUE(refuses([&](json& d) { d["samplers"][0]["magFilter"] = bad; })) << bad;
        EXPECT_TRUE(refuses([&](json& d) { d["materials"][1]["alphaMode"] = bad; })) << bad;
        EXPECT_TRUE(refuses([&](json& d) { d["materials"][1]["doubleSided"] = bad; })) << bad;
        EXPECT_TRUE(refuses([&](json& d) {
            d["materials"][1]["emissiveFactor"] = {bad, 0, 0};
        })) << bad;
        EXPECT_TRUE(refuses([&](json& d) {
            d["materials"][1]["occlusionTexture"]["extensions"]["KHR_texture_transform"]["scale"] =
                bad;
        })) << bad;
    }
    EXPECT_TRUE(refuses([](json& d) { d["textures"][0].erase("source"); }));
    EXPECT_TRUE(refuses([](json& d) { d["materials"][1]["alphaCutoff"] = -1; }));
    EXPECT_TRUE(refuses([](json& d) { d["materials"][1]["normalTexture"]["scale"] = 1e30; }));
    EXPECT_TRUE(refuses([](json& d) {
        d["materials"] = json::array();
        for (std::uint32_t i = 0; i <= kMaxMeshMaterials; ++i)
            d["materials"].push_back(json::object());
    }));
}

TEST(MeshCodecScene, HostileImages)
{
    const auto refuses = [](auto&& edit) {
        return !errorAfter([&](json& d) {
                    d["meshes"][0]["extensions"]["PENUMBRA_shadow_field"].erase("imageChecksum");
                    edit(d);
                }).empty();
    };
    EXPECT_FALSE(refuses([](json&) {}));
    EXPECT_TRUE(refuses([](json& d) { d["images"][0]["mimeType"] = "image/jpeg"; }));
    EXPECT_TRUE(refuses([](json& d) { d["images"][0]["mimeType"] = "image/webp"; }));
    EXPECT_TRUE(refuses([](json& d) { d["images"][0].erase("mimeType"); }));
    EXPECT_TRUE(refuses([](json& d) { d["images"][0]["bufferView"] = 0; })); // Draco is no PNG
    EXPECT_TRUE(refuses([](json& d) { d["images"][0]["bufferView"] = 99; }));
    EXPECT_TRUE(refuses([](json& d) { d["images"][0] = {{"uri", "/etc/hostname"}}; }));
    EXPECT_TRUE(refuses([](json& d) {
        d["images"] = json(std::vector<json>(kMaxMeshImages + 1, d["images"][0]));
    }));
}

TEST(MeshCodecScene, HostileLights)
{
    const auto refuses = [](const char* key, const json& value) {
        return !errorAfter([&](json& d) {
                    d["extensions"]["KHR_lights_punctual"]["lights"][1][key] = value;
                }).empty();
    };
    EXPECT_TRUE(refuses("type", "laser"));
    EXPECT_TRUE(refuses("color", {1, 2, 0}));
    EXPECT_TRUE(refuses("intensity", -1));
    EXPECT_TRUE(refuses("intensity", 1e30));
    EXPECT_TRUE(refuses("range", 0));
    EXPECT_TRUE(refuses("spot", {{"innerConeAngle", 0.6}, {"outerConeAngle", 0.5}}));
    EXPECT_TRUE(refuses("spot", {{"outerConeAngle", 2}}));
    const auto refusesNode = [](auto&& edit) {
        return !errorAfter([&](json& d) { edit(d["nodes"].back()); }).empty();
    };
    EXPECT_TRUE(refusesNode([](json& n) { n["rotation"] = {0, 0, 0, 0}; }));
    EXPECT_TRUE(refusesNode([](json& n) { n["rotation"] = {0, 0, 1}; }));
    EXPECT_TRUE(refusesNode([](json& n) { n["translation"] = {0, 0, 1e20}; }));
    EXPECT_TRUE(refusesNode([](json& n) { n["extensions"]["KHR_lights_punctual"]["light"] = 3; }));
    EXPECT_TRUE(refusesNode([](json& n) { n["extensions"]["KHR_lights_punctual"] = 3; }));
    EXPECT_NE(errorAfter([](json& d) {
                  for (int i = 0; i < 300; ++i)
                      d["nodes"].push_back(d["nodes"].back());
              }),
              "");
}

TEST(MeshCodecScene, HostileLods)
{
    const auto refuses = [](const json& errors) {
        return !errorAfter([&](json& d) {
                    d["meshes"][0]["extensions"]["PENUMBRA_shadow_field"]["lodErrors"] = errors;
                }).empty();
    };
    EXPECT_TRUE(refuses({-1}));
    EXPECT_TRUE(refuses({"x"}));
    EXPECT_TRUE(refuses({0.1, 0.2})); // there is one mesh more, not two
    EXPECT_TRUE(refuses(std::vector<int>(5, 0)));
    EXPECT_TRUE(refuses("x"));
    EXPECT_FALSE(refuses(json::array()));
}

TEST(MeshCodecScene, EncodeRefusesWhatDecodeWouldRefuse)
{
    const auto refuses = [](auto&& spoil) {
        MeshAsset mesh = sampleScene();
        spoil(mesh);
        return !encodeMeshAsset(mesh);
    };
    EXPECT_FALSE(refuses([](MeshAsset&) {}));
    EXPECT_TRUE(refuses([](MeshAsset& m) { m.submeshes[1].material = 2; }));
    EXPECT_TRUE(refuses([](MeshAsset& m) { m.submeshes[1].firstVertex -= 1; }));
    EXPECT_TRUE(refuses([](MeshAsset& m) { m.submeshes[1].indexCount -= 3; }));
    EXPECT_TRUE(refuses([](MeshAsset& m) { m.submeshes[1].vertexCount = 0xffffffff; }));
    EXPECT_TRUE(refuses([](MeshAsset& m) { std::swap(m.indices[0], m.indices.back()); }));
    EXPECT_TRUE(refuses([](MeshAsset& m) { m.texcoords0.pop_back(); }));
    EXPECT_TRUE(refuses([](MeshAsset& m) { m.texcoords0[4].x = NAN; }));
    EXPECT_TRUE(refuses([](MeshAsset& m) { m.texcoords1.clear(); })); // the normal map needs it
    EXPECT_TRUE(refuses([](MeshAsset& m) { m.colors.pop_back(); }));
    EXPECT_TRUE(refuses([](MeshAsset& m) { m.materials[1].emissive.r = -1; }));
    EXPECT_TRUE(refuses([](MeshAsset& m) { m.materials[1].textures[0]->image = 2; }));
    EXPECT_TRUE(refuses([](MeshAsset& m) { m.materials[1].textures[0]->wrapS = 1; }));
    EXPECT_TRUE(refuses([](MeshAsset& m) { m.images[0].type = ImageType::Jpeg; }));
    EXPECT_TRUE(refuses([](MeshAsset& m) { m.images[0].bytes.clear(); }));
    EXPECT_TRUE(refuses([](MeshAsset& m) { m.lights[1].innerCone = 1; }));
    EXPECT_TRUE(refuses([](MeshAsset& m) { m.lights[1].direction = vec3{0}; }));
    EXPECT_TRUE(refuses([](MeshAsset& m) { m.lods[0].error = -1; }));
    EXPECT_TRUE(refuses([](MeshAsset& m) { m.lods[0].normals[2] = vec3{0}; }));
    EXPECT_TRUE(refuses([](MeshAsset& m) { m.lods.resize(5, m.lods[0]); }));
}

TEST(MeshCodecScene, MutationsNeverCrash)
{
    const auto whole = *encodeMeshAsset(sampleScene());
    const auto glb = *readGlb(whole);
    json document = json::parse(glb.json);
    for (json& mesh : document["meshes"])
        for (const char* member : {"geometryChecksum", "fieldChecksum", "imageChecksum"})
            mesh["extensions"]["PENUMBRA_shadow_field"].erase(member);
    const auto bytes = *writeGlb(document.dump(), glb.bin);
    ASSERT_TRUE(decodeMeshAsset(bytes));
    std::mt19937 random(1);
    for (int round = 0; round < 4000; ++round) {
        auto mutant = bytes;
        mutant[random() % mutant.size()] = static_cast<std::byte>(random());
        const auto decoded = decodeMeshAsset(mutant);
        if (decoded) {
            EXPECT_TRUE(validateMesh(*decoded));
        }
    }
}

} // namespace penumbra
