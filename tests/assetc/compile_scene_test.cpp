// assetc bake --per-node: the parts, put where scene.json says, are the file's own triangles.
#include "assetc/compile_scene.h"
#include "assetc/import/import.h"
#include "tests/assetc/gltf_fixture.h"
#include "tests/support/program.h"

#include <gtest/gtest.h>

namespace penumbra {

namespace {

using nlohmann::json;

CompileOptions quickOptions()
{
    CompileOptions options;
    options.bake.shells = 2;
    options.bake.side = 3;
    options.bake.directions = 16;
    options.bake.rasterSide = 64;
    return options;
}

Result<CompiledScene> compileJson(const json& document)
{
    const TemporaryFolder folder;
    Progress progress("test");
    return compileScene(folder.write("file.gltf", document.dump()), quickOptions(), progress);
}

// Positions of every entity's mesh in the world, by its Transform and those of its parents.
std::vector<vec3> placedPositions(const CompiledScene& scene)
{
    const json document = json::parse(scene.json);
    std::vector<vec3> placed;
    for (const json& entity : document["entities"]) {
        if (!entity.contains("MeshInstance"))
            continue;
        for (const SceneAsset& part : scene.assets)
            if (part.file == entity["MeshInstance"]["asset"])
                for (vec3 p : part.asset.mesh.positions) {
                    for (const json* at = &entity; at != nullptr;) {
                        const json& t = (*at)["Transform"];
                        const quat turn(t["rotation"][3], t["rotation"][0], t["rotation"][1],
                                        t["rotation"][2]);
                        p = turn * (p * t["scale"].get<float>()) +
                            vec3(t["position"][0], t["position"][1], t["position"][2]);
                        at = at->contains("Parent")
                                 ? &document["entities"]
                                            [static_cast<std::size_t>((*at)["Parent"]["entity"])]
                                 : nullptr;
                    }
                    placed.push_back(p);
                }
    }
    return placed;
}

// Law: what --per-node places is what the merged import has.
void expectSamePlaces(const json& document)
{
    const TemporaryFolder folder;
    const auto merged = importMesh(folder.write("file.gltf", document.dump()));
    ASSERT_TRUE(merged) << merged.error().message;
    const auto scene = compileJson(document);
    ASSERT_TRUE(scene) << scene.error().message;
    const std::vector<vec3> placed = placedPositions(*scene);
    ASSERT_EQ(placed.size(), merged->mesh.positions.size());
    for (const vec3 p : merged->mesh.positions) {
        float nearest = 1e9f;
        for (const vec3 q : placed)
            nearest = min(nearest, length(p - q));
        EXPECT_LT(nearest, 1e-3f) << p.x << " " << p.y << " " << p.z;
    }
}

} // namespace

TEST(CompileScene, RigidNodesShareAssetsAndOthersDoNot)
{
    const auto scene = compileJson(armGltf());
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_EQ(scene->assets.size(), 3u);
    EXPECT_EQ(scene->assets[0].file, "upper_arm.glb");
    const json document = json::parse(scene->json);
    EXPECT_EQ(document["version"], 1);
    const json& entities = document["entities"];
    ASSERT_EQ(entities.size(), 5u);
    EXPECT_EQ(entities[0]["Name"]["value"], "base");
    EXPECT_FALSE(entities[0].contains("MeshInstance") || entities[0].contains("Parent"));
    EXPECT_EQ(entities[2]["Parent"]["entity"], 1);
    EXPECT_EQ(entities[1]["MeshInstance"], entities[2]["MeshInstance"]);
    EXPECT_EQ(entities[1]["ShadowFieldOccluder"], entities[1]["MeshInstance"]);
    EXPECT_NE(entities[3]["MeshInstance"], entities[2]["MeshInstance"]); // squeezed
    EXPECT_NE(entities[4]["MeshInstance"], entities[2]["MeshInstance"]); // mirrored
    EXPECT_NEAR(entities[1]["Transform"]["scale"].get<float>(), 2, 1e-6f);
    EXPECT_NEAR(entities[2]["Transform"]["scale"].get<float>(), 1, 1e-6f);
    for (const SceneAsset& part : scene->assets)
        EXPECT_TRUE(decodeMeshAsset(part.asset.bytes)) << part.file;
}

TEST(CompileScene, PartsStandWhereTheMergedMeshHasThem)
{
    expectSamePlaces(armGltf());
    json sheared = armGltf(); // a squeeze above turned children is a shear below
    sheared["nodes"][0]["scale"] = {1, 4, 0.5};
    expectSamePlaces(sheared);
    json flat = armGltf();
    flat["nodes"][3]["scale"] = {1, 1, 0};
    expectSamePlaces(flat);
}

TEST(CompileScene, InstancesShareOneAsset)
{
    json document = squareGltf();
    const std::size_t translations =
        addAccessor<float>(document, {0, 0, 0, 0, 0, 5, 0, 0, 9}, 5126, "VEC3", 3);
    const std::size_t scales =
        addAccessor<float>(document, {1, 1, 1, 2, 2, 2, 1, 2, 1}, 5126, "VEC3", 3);
    document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", translations}, {"SCALE", scales}};
    const auto scene = compileJson(document);
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->assets.size(), 2u); // the third is squeezed
    EXPECT_EQ(json::parse(scene->json)["entities"].size(), 4u);
    expectSamePlaces(document);
}

TEST(CompileScene, NamesAreMadeSafeAndUnique)
{
    json document = armGltf();
    document["nodes"][1]["name"] = "../../etc/passwd";
    document["nodes"][3]["name"] = "Lid";
    document["nodes"][4]["name"] = "lid";
    const auto scene = compileJson(document);
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->assets[0].file, "_._.._etc_passwd.glb");
    EXPECT_EQ(scene->assets[1].file, "Lid.glb");
    EXPECT_EQ(scene->assets[2].file, "lid_2.glb");
}

TEST(CompileScene, LightsNameTheirEntity)
{
    json document = armGltf();
    document["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    document["nodes"][2]["extensions"]["KHR_lights_punctual"]["light"] = 0;
    const auto scene = compileJson(document);
    ASSERT_TRUE(scene) << scene.error().message;
    const json lights = json::parse(scene->json)["lights"];
    ASSERT_EQ(lights.size(), 1u);
    EXPECT_EQ(lights[0]["entity"], 2);
    EXPECT_EQ(lights[0]["type"], "point");
}

TEST(CompileScene, SkinsAreRefusedByName)
{
    json document = armGltf();
    document["skins"] = {{{"joints", {0}}}};
    document["nodes"][3]["skin"] = 0;
    const auto scene = compileJson(document);
    ASSERT_FALSE(scene);
    EXPECT_NE(scene.error().message.find("nodes[3] \"claw\": has a skin"), std::string::npos)
        << scene.error().message;
}

TEST(CompileScene, CommandWritesAllOrNothing)
{
    const TemporaryFolder folder;
    const auto run = [&](const std::string& arguments) {
        return runProgram(PENUMBRA_ASSETC, arguments, folder);
    };
    const auto at = [&](const char* name) { return fmt::format("'{}'", (folder / name).string()); };
    const std::string quick = " --per-node --shells 2 --max-side 3 --directions 16";
    folder.write("arm.gltf", armGltf().dump());
    const Outcome good = run("bake " + at("arm.gltf") + " -o " + at("arm") + quick + " --report " +
                             at("report.json"));
    EXPECT_EQ(good.code, 0) << good.err;
    for (const char* name : {"arm/upper_arm.glb", "arm/claw.glb", "arm/twin.glb"})
        EXPECT_EQ(run("validate " + at(name)).code, 0) << name;
    EXPECT_EQ(json::parse(readText(folder / "arm/scene.json"))["entities"].size(), 5u);
    EXPECT_EQ(json::parse(readText(folder / "report.json"))["assets"].size(), 3u);

    json skinned = armGltf();
    skinned["skins"] = {{{"joints", {0}}}};
    skinned["nodes"][4]["skin"] = 0;
    folder.write("bad.gltf", skinned.dump());
    EXPECT_EQ(run("bake " + at("bad.gltf") + " -o " + at("bad") + quick).code, 1);
    EXPECT_FALSE(std::filesystem::exists(folder / "bad"));
    EXPECT_EQ(run("bake " + at("arm.gltf") + " -o " + at("arm.gltf") + quick).code, 2);
    EXPECT_EQ(run("bake " + at("arm.gltf") + " -o " + at("x.glb") + " --lods 5").code, 2);
}

} // namespace penumbra
