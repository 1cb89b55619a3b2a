// What is wrong with a manifest is said at once, each with its place, and nothing is built.
#include "tests/assetc/build_fixture.h"

#include <algorithm>

namespace penumbra {

TEST_F(BuildTest, WrongManifestsWriteNothing)
{
    writePyramids(1);
    const std::string a = R"({"name":"a","source":"m0.obj")";
    const auto nested = [](int depth) {
        return std::string(static_cast<std::size_t>(depth), '[') +
               std::string(static_cast<std::size_t>(depth), ']');
    };
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"", "an empty file"},
        {"[]", "root is not an object"},
        {"{\n \"version\": 1,\n \"assets\": [}", "line 3, column 13"},
        {"{\"a\":" + nested(60000) + "}", "nested deeper"},
        {R"({"assets":[]})", "has no \"version\""},
        {R"({"version":2,"assets":[]})", "version is 2, this program reads 1"},
        {R"({"version":1})", "has no \"assets\""},
        {R"({"version":1,"assets":{}})", "assets is an object, not an array"},
        {R"({"version":1,"assets":[],"more":1})", "unknown member \"more\""},
        {R"({"version":1,"assets":[],"defaults":{"bread":{}}})",
         "defaults has the unknown member \"bread\""},
        {R"({"version":1,"assets":[],"defaults":{"mesh":{"shells":1}}})", "defaults.mesh.shells"},
        {R"({"version":1,"assets":[7]})", "assets[0] is 7, not an object"},
        {R"({"version":1,"assets":[{"source":"m0.obj"}]})", "assets[0] has no \"name\""},
        {R"({"version":1,"assets":[{"name":"a"}]})", "assets[0] has no \"source\""},
        {R"({"version":1,"assets":[)" + a + "}," + a + "}]}", "assets[1].name"},
        {R"({"version":1,"assets":[)" + a + R"(,"kind":"bread"}]})", "assets[0].kind"},
        {R"({"version":1,"assets":[)" + a + R"(,"kind":""}]})", "assets[0].kind"},
        {R"({"version":1,"assets":[)" + a + R"(,"kind":1}]})", "assets[0].kind"},
        {R"({"version":1,"assets":[)" + a + R"(,"shells":4}]})", "unknown member \"shells\""},
        {R"({"version":1,"assets":[)" + a + R"(,"options":[]}]})", "assets[0].options"},
        {R"({"version":1,"assets":[)" + a + R"(,"options":{"shells":"4"}}]})",
         "assets[0].options.shells"},
        {R"({"version":1,"assets":[)" + a + R"(,"options":{"shells":129}}]})",
         "assets[0].options.shells"},
        {R"({"version":1,"assets":[)" + a + R"(,"options":{"maxSide":64}}]})",
         "assets[0].options.maxSide"},
        {R"({"version":1,"assets":[)" + a + R"(,"options":{"directions":33}}]})",
         "assets[0].options.directions"},
        {R"({"version":1,"assets":[)" + a + R"(,"options":{"threshold":2}}]})",
         "assets[0].options.threshold"},
        {R"({"version":1,"assets":[)" + a + R"(,"options":{"field":1}}]})",
         "assets[0].options.field"},
        {R"({"version":1,"assets":[{"name":"a","source":"m0.stl"}]})", "assets[0].source"},
        {R"({"version":1,"assets":[{"name":"a","source":""}]})", "assets[0].source"},
        {R"({"version":1,"assets":[{"name":"a","source":"m0.obj\n"}]})", "assets[0].source"},
    };
    for (const auto& [text, place] : cases) {
        folder.write("manifest.json", text);
        build(1);
        EXPECT_NE(outcome.err.find("manifest.json: "), std::string::npos) << text.substr(0, 200);
        EXPECT_NE(outcome.err.find(place), std::string::npos) << place << "\n" << outcome.err;
    }
    for (const char* name :
         {"", "/a", "../a", "a/../b", "a//b", "a/", ".", ".penumbra/lock", "a\\b", "a\nb", ".a"}) {
        manifest["assets"][0]["name"] = name;
        writeManifest();
        build(1);
        EXPECT_NE(outcome.err.find("assets[0].name"), std::string::npos) << name << outcome.err;
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "built"));
}

TEST_F(BuildTest, EveryProblemOfAManifestIsListedAtOnce)
{
    folder.write("m.obj", pyramid(1));
    folder.write("scene.fbx", "Kaydara FBX Binary  ....");
    folder.write("plain.txt", pyramid(1));
    std::filesystem::create_directory(folder / "dir");
    manifest["assets"] = {{{"name", "a"}, {"source", "scene.fbx"}},
                          {{"name", "b"}, {"source", "none.obj"}},
                          {{"name", "c"}, {"source", "dir"}},
                          {{"name", "d"}, {"source", "dir"}, {"kind", "mesh"}},
                          {{"name", "e"}, {"source", "plain.txt"}},
                          {{"name", "f"}, {"source", "m.obj"}, {"options", {{"shells", 1}}}},
                          {{"name", "g"}, {"source", "m.obj"}}};
    writeManifest();
    build(1);
    for (const char* says :
         {"assets[0].source is an FBX scene; export it as glTF",
          "assets[1].source cannot be used: ", "none.obj: cannot open: No such file",
          "assets[2].source cannot be used: ", "dir: a folder; name a file in it",
          "assets[3].source cannot be used: ",
          "assets[4].source is \"plain.txt\", whose ending is none of .glb, .gltf, .obj",
          "assets[5].options.shells is 1, not a whole number from 2 to 128"})
        EXPECT_NE(outcome.err.find(says), std::string::npos) << says << "\n" << outcome.err;
    EXPECT_EQ(outcome.err.find("rename"), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 6) << outcome.err;

    // Alone, a missing source fails its asset only; for validate it is a problem.
    manifest["assets"] = {{{"name", "b"}, {"source", "none.obj"}},
                          {{"name", "g"}, {"source", "m.obj"}}};
    manifest["source"] = "m.obj"; // does not make it a report
    writeManifest();
    build(1);
    EXPECT_NE(outcome.err.find("has the unknown member \"source\""), std::string::npos)
        << outcome.err;
    manifest.erase("source");
    writeManifest();
    EXPECT_EQ(named(build(1), "built"), Names({"g"}));
    outcome = runProgram(PENUMBRA_ASSETC, "validate '" + at("manifest.json") + "'", folder);
    EXPECT_EQ(outcome.code, 1);
    EXPECT_NE(outcome.out.find("assets[0].source cannot be used"), std::string::npos);
}

TEST_F(BuildTest, OptionsFollowTheRulesOfTheCommandLine)
{
    folder.write("m.obj", pyramid(1));
    const auto asset = [](const char* name, const nlohmann::json& options) {
        return nlohmann::json{{"name", name}, {"source", "m.obj"}, {"options", options}};
    };
    manifest["assets"] = {asset("a", {{"targetError", 0.2}}), asset("b", {{"directions", 33}}),
                          asset("c", {{"maxSide", 64}}), asset("d", {{"shells", 2.5}}),
                          asset("e", {{"field", false},
                                      {"targetError", 0.2},
                                      {"shells", nullptr},
                                      {"maxSide", nullptr},
                                      {"directions", nullptr}})};
    writeManifest();
    build(1);
    for (const char* says :
         {"assets[0].options has targetError beside shells, which it picks itself; leave out one, "
          "or "
          "set it to null where it is a default",
          "assets[0].options has targetError beside maxSide", "targetError beside directions",
          "assets[1].options.directions is 33, not an even number from 2 to 65536",
          "assets[2].options.maxSide is 64, not a number 2^k + 1 from 3 to 257",
          "assets[3].options.shells is 2.5, not a whole number from 2 to 128",
          "assets[4].options has targetError beside field: false, which leaves no field"})
        EXPECT_NE(outcome.err.find(says), std::string::npos) << says << "\n" << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 7) << outcome.err;

    // null: what the compiler has by default, not the manifest.
    manifest["defaults"]["mesh"]["lods"] = nullptr;
    manifest["assets"] = {asset("a", {{"threshold", 0}, {"shells", nullptr}}),
                          asset("b", {{"targetError", 0.2},
                                      {"shells", nullptr},
                                      {"maxSide", nullptr},
                                      {"directions", nullptr}})};
    writeManifest();
    const auto report = build();
    EXPECT_EQ(report["assets"][0]["compile"]["field"]["shells"], 32) << outcome.err;
    EXPECT_EQ(report["assets"][0]["compile"]["field"]["sides"][0], 5);
    EXPECT_EQ(report["assets"][1]["compile"]["target"]["reached"], true);
}

TEST_F(BuildTest, ProblemsAreSaidOnce)
{
    folder.write("m.obj", pyramid(1));
    folder.write("manifest.json",
                 R"({"version":1,"version":1,"defaults":{"mesh":{"shells":1}},"assets":[)"
                 R"({"name":5,"source":"m.obj"},{"name":"b","source":6},{"name":"c","kind":7,)"
                 R"("source":"m.obj"},{"name":"d","name":"e","source":"m.obj"}]})");
    build(1);
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 6) << outcome.err;
    for (const char* says :
         {"manifest.json: has \"version\" twice; delete one", "assets[3] has \"name\" twice",
          "defaults.mesh.shells is 1, not", "assets[0].name is 5, not text",
          "assets[1].source is 6, not text", "assets[2].kind is 7, not text"})
        EXPECT_NE(outcome.err.find(says), std::string::npos) << says << "\n" << outcome.err;
    manifest["assets"] = nlohmann::json::array();
    for (int i = 0; i < 25; ++i)
        manifest["assets"].push_back({{"name", "a"}});
    writeManifest();
    build(1);
    EXPECT_NE(outcome.err.find("more; assetc validate lists all"), std::string::npos)
        << outcome.err;
}

TEST_F(BuildTest, TheRemedyOfAWrongKindIsTheKind)
{
    folder.write("lamp.json", R"({"version":1,"type":"sphere","radius":1,"power":[1,1,1]})");
    folder.write("sky.glb", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n12341234");
    manifest["assets"] = {{{"name", "a"}, {"kind", "mesh"}, {"source", "lamp.json"}},
                          {{"name", "b"}, {"source", "sky.glb"}}};
    writeManifest();
    build(1);
    const Outcome checked =
        runProgram(PENUMBRA_ASSETC, "validate '" + at("manifest.json") + "'", folder);
    for (const char* says :
         {"is a light description; give the asset \"kind\": \"light\"",
          "is a Radiance .hdr picture; give the asset \"kind\": \"environment\""}) {
        EXPECT_NE(outcome.err.find(says), std::string::npos) << outcome.err;
        EXPECT_NE(checked.out.find(says), std::string::npos) << checked.out;
    }
    EXPECT_EQ(outcome.err.find("assetc light"), std::string::npos) << outcome.err;
}

TEST_F(BuildTest, NoNameMakesAFolderOfAFile)
{
    folder.write("m.obj", pyramid(1));
    folder.write("room.gltf", squareGltf().dump());
    for (const auto& [first, second, folderName] : {std::tuple{"a", "a.glb/b", "a.glb"},
                                                    {"a", "a.glb.d/b", "a.glb.d"},
                                                    {"x/a", "x/a.glb/c/b", "x/a.glb"}}) {
        manifest["assets"] = {{{"name", second}, {"source", "m.obj"}},
                              {{"name", first}, {"source", "m.obj"}}};
        writeManifest();
        build(1);
        EXPECT_NE(outcome.err.find(fmt::format("assets[0].name makes \"{}\" a folder, which is a "
                                               "file of assets[1]; choose another name",
                                               folderName)),
                  std::string::npos)
            << outcome.err;
    }
    manifest["assets"] = {{{"name", "a.glb"}, {"kind", "scene"}, {"source", "room.gltf"}},
                          {{"name", "a"}, {"source", "m.obj"}}};
    writeManifest();
    build(1);
    EXPECT_NE(outcome.err.find("choose another name"), std::string::npos) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "built"));
}

} // namespace penumbra
