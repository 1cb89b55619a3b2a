// What a compiled light says of its surface: emission beyond 1, and the cone of a spot.
#include "assets/glb.h"
#include "assets/mesh_codec.h"
#include "tests/assets/sample_assets.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace penumbra {

namespace {

using nlohmann::json;

constexpr const char* kStrength = "KHR_materials_emissive_strength";

MeshAsset glowing(vec3 emissive, vec2 cone = vec2(0))
{
    MeshAsset mesh = sampleScene();
    mesh.materials[1].emissive = emissive;
    mesh.materials[1].emissionCone = cone;
    return mesh;
}

json documentOf(const MeshAsset& mesh)
{
    return json::parse(readGlb(*encodeMeshAsset(mesh))->json);
}

// Decodes `mesh` after `edit` has changed material 1 of its JSON.
template <class Edit>
Result<MeshAsset> decodedAfter(const MeshAsset& mesh, Edit edit)
{
    const auto bytes = *encodeMeshAsset(mesh);
    const auto glb = *readGlb(bytes);
    json document = json::parse(glb.json);
    edit(document["materials"][1]);
    return decodeMeshAsset(*writeGlb(document.dump(), glb.bin));
}

} // namespace

TEST(MeshCodecEmission, StrengthAndConeComeBack)
{
    for (const vec3 emissive : {vec3(0), vec3(0.25f, 1, 0.5f), vec3(3, 40, 0.125f), vec3(1e7f)})
        for (const vec2 cone : {vec2(0), vec2(0.25f, 0.5f), vec2(0, 1.5f)}) {
            const Result<MeshAsset> decoded =
                decodeMeshAsset(*encodeMeshAsset(glowing(emissive, cone)));
            ASSERT_TRUE(decoded) << decoded.error().message;
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(decoded->materials[1].emissive[c], emissive[c], 1e-6f * emissive[c]);
            EXPECT_EQ(decoded->materials[1].emissionCone, cone);
        }
}

// glTF's own factor ends at 1: viewers that do not know the extension still show the colour.
TEST(MeshCodecEmission, FactorStaysWithinGltfAndTheStrengthIsNamedOnlyWhereNeeded)
{
    const json bright = documentOf(glowing({3, 40, 0.125f}));
    EXPECT_NEAR(bright["materials"][1]["emissiveFactor"][1].get<float>(), 1, 1e-6f);
    EXPECT_NEAR(bright["materials"][1]["extensions"][kStrength]["emissiveStrength"].get<float>(),
                40, 1e-5f);
    EXPECT_NE(bright["extensionsUsed"].dump().find(kStrength), std::string::npos);
    const json dim = documentOf(glowing({0.25f, 1, 0.5f}));
    EXPECT_EQ(dim["extensionsUsed"].dump().find(kStrength), std::string::npos);
}

TEST(MeshCodecEmission, HostileNumbersAreRefused)
{
    const MeshAsset mesh = glowing({3, 40, 0.125f}, {0.25f, 0.5f});
    ASSERT_TRUE(decodedAfter(mesh, [](json&) {}));
    for (const json& bad : {json(-1), json(1e30), json("x"), json(nullptr), json::array()})
        EXPECT_FALSE(decodedAfter(mesh, [&](json& m) {
            m["extensions"][kStrength]["emissiveStrength"] = bad;
        })) << bad;
    for (const json& bad :
         {json(-1), json(7), json("x"), json::array(), json::array({0.5}), json::array({0.5, 0.25}),
          json::array({-0.1, 0.5}), json::array({0.1, 1.7}), json::array({0.5, 0.5}),
          json::array({"a", 0.5}), json::array({0, 1e300})})
        EXPECT_FALSE(decodedAfter(mesh, [&](json& m) {
            m["extensions"]["PENUMBRA_shadow_field"]["emissionCone"] = bad;
        })) << bad;
    // The extension without its member has the member's default, 1.
    const Result<MeshAsset> plain =
        decodedAfter(mesh, [](json& m) { m["extensions"][kStrength] = json::object(); });
    ASSERT_TRUE(plain);
    EXPECT_NEAR(plain->materials[1].emissive.g, 1, 1e-6f);
}

} // namespace penumbra
