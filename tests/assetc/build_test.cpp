// `assetc build`: what is compiled again, and what is not.
#include "assetc/build/fingerprint.h"
#include "assets/environment.h"
#include "assets/glb.h"
#include "assets/mesh_codec.h"
#include "tests/assetc/build_fixture.h"

#include <algorithm>

namespace penumbra {

TEST_F(BuildTest, BuildsThenNothing)
{
    writePyramids(3);
    folder.write("sky.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n" +
                                std::string("\x80\x40\x20\x81\x80\x40\x20\x81", 8));
    manifest["assets"].push_back({{"name", "skies/sky"}, {"source", "sky.hdr"}});
    writeManifest();
    const auto first = build();
    EXPECT_EQ(named(first, "built"), Names({"m0", "m1", "m2", "skies/sky"})) << outcome.err;
    EXPECT_EQ(first["totals"]["built"], 4);
    EXPECT_GT(first["totals"]["peakBytes"], 1 << 20);
    EXPECT_EQ(first["assets"][0]["compile"]["field"]["shells"], 3); // the manifest's default
    EXPECT_NE(outcome.out.find("4 assets, 4 built"), std::string::npos) << outcome.out;
    EXPECT_EQ(outcome.err, ""); // no progress in a pipe
    for (const auto& [name, bytes] : files()) {
        const auto span = std::as_bytes(std::span(bytes));
        if (name.ends_with(".env"))
            EXPECT_TRUE(decodeEnvironment(span)) << name;
        else
            EXPECT_TRUE(decodeMeshAsset(span)) << name;
    }
    const auto before = files();
    EXPECT_EQ(before.size(), 4u);
    const auto second = build();
    EXPECT_EQ(named(second, "unchanged").size(), 4u);
    EXPECT_EQ(second["assets"][0]["key"], first["assets"][0]["key"]);
    EXPECT_EQ(files(), before);
}

TEST_F(BuildTest, ChangedContentRebuildsExactlyOne)
{
    writePyramids(3);
    build();
    folder.write("m1.obj", pyramid(2)); // as before: touched, not changed
    EXPECT_EQ(named(build(), "built"), Names());
    folder.write("m1.obj", pyramid(9)); // of the same size
    EXPECT_EQ(named(build(), "built"), Names({"m1"}));
    EXPECT_EQ(named(build(), "built"), Names());
}

TEST_F(BuildTest, ChangedContentOfAnEqualTimeIsSeen)
{
    writePyramids(2);
    build();
    const auto time = std::filesystem::last_write_time(folder / "m1.obj");
    folder.write("m1.obj", pyramid(9));
    std::filesystem::last_write_time(folder / "m1.obj", time);
    EXPECT_EQ(named(build(), "built"), Names({"m1"}));
}

TEST_F(BuildTest, FilesBesideTheSourceCount)
{
    auto square = squareGltf();
    const std::string uri = square["buffers"][0]["uri"];
    const std::string positions = bytesOf<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
    const std::string rest = bytesOf<std::uint16_t>({0, 1, 2, 0, 2, 3}) +
                             bytesOf<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
    square["buffers"][0]["uri"] = "parts/square%20a.bin";
    folder.write("square.gltf", square.dump());
    folder.write("parts/square a.bin", positions + rest);
    folder.write("colour.obj", "mtllib colour.mtl\nusemtl red\n" + pyramid(1));
    folder.write("plain.obj", pyramid(1));
    for (const char* source : {"square.gltf", "colour.obj", "plain.obj"})
        manifest["assets"].push_back({{"name", std::string(source, 5)}, {"source", source}});
    writeManifest();
    EXPECT_EQ(named(build(), "built").size(), 3u);
    EXPECT_EQ(named(build(), "built"), Names());

    const std::string moved = bytesOf<float>({0, 0, 0, 1, 0, 0, 1, 2, 0, 0, 1, 0});
    folder.write("parts/square a.bin", moved + rest);
    EXPECT_EQ(named(build(), "built"), Names({"squar"}));
    folder.write("colour.mtl", "newmtl red\nKd 1 0 0\n"); // it was missing so far
    EXPECT_EQ(named(build(), "built"), Names({"colou"}));
    folder.write("colour.mtl", "newmtl red\nKd 0 1 0\n");
    EXPECT_EQ(named(build(), "built"), Names({"colou"}));
    EXPECT_EQ(named(build(), "built"), Names());
}

TEST_F(BuildTest, ChangedOptionsRebuildWhatHasThem)
{
    writePyramids(3);
    const auto first = build();
    manifest["assets"][2]["options"] = {{"shells", 4}};
    writeManifest();
    const auto second = build();
    EXPECT_EQ(named(second, "built"), Names({"m2"}));
    EXPECT_EQ(second["assets"][2]["compile"]["field"]["shells"], 4);
    EXPECT_EQ(second["assets"][2]["compile"]["field"]["sides"][3], 5); // the default stays
    manifest["defaults"]["mesh"]["directions"] = 34;
    writeManifest();
    EXPECT_EQ(named(build(), "built").size(), 3u);
}

TEST_F(BuildTest, LostOrSpoiltOutputIsMadeAgain)
{
    writePyramids(3);
    build();
    const auto good = files();
    std::filesystem::remove(folder / "built/m0.glb");
    std::string spoilt = good.at("m1.glb");
    spoilt[spoilt.size() / 2] ^= 1;
    folder.write("built/m1.glb", spoilt);
    std::filesystem::remove(folder / "built/m2.glb.d");
    EXPECT_EQ(named(build(), "built"), Names({"m0", "m1"}));
    EXPECT_EQ(files(), good);
    EXPECT_TRUE(std::filesystem::exists(folder / "built/m2.glb.d"));
    for (const char* record : {"", "{}", "{\"version\":1,\"key\":7}", "\xff"}) { // damaged
        folder.write("built/.penumbra/records/m0.glb.json", record);
        EXPECT_EQ(named(build(), "built"), Names({"m0"})) << record;
    }
}

TEST_F(BuildTest, AFailureStopsNoOther)
{
    writePyramids(4);
    folder.write("m1.obj", "v 1 2 x\n");
    std::filesystem::remove(folder / "m2.obj");
    const auto report = build(1);
    EXPECT_EQ(named(report, "built"), Names({"m0", "m3"}));
    EXPECT_EQ(named(report, "failed"), Names({"m1", "m2"}));
    EXPECT_NE(outcome.err.find("assets[1] \"m1\": "), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("m1.obj: line 1"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("assets[2] \"m2\": "), std::string::npos) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "built/m1.glb"));
    EXPECT_EQ(named(build(1), "failed"), Names({"m1", "m2"})); // again, since nothing changed
    folder.write("m1.obj", pyramid(1));
    folder.write("m2.obj", pyramid(1));
    EXPECT_EQ(named(build(), "built"), Names({"m1", "m2"}));
}

TEST_F(BuildTest, SameBytesForAnyJobs)
{
    writePyramids(5);
    build(0, "--jobs 1", "one");
    build(0, "--jobs 2", "two");
    EXPECT_EQ(files("one").size(), 5u);
    EXPECT_EQ(files("one"), files("two"));
}

TEST_F(BuildTest, NoOutputReplacesASource)
{
    writePyramids(1);
    build(0, "", "art");
    const auto compiled = files("art");
    folder.write("art/m1.glb", compiled.at("m0.glb"));
    manifest["assets"].push_back({{"name", "m1"}, {"source", "art/m1.glb"}});
    writeManifest();
    build(1, "", "art");
    EXPECT_NE(outcome.err.find("manifest.json: assets[1].name: the output " + at("art/m1.glb") +
                               " would replace the source of assets[1]"),
              std::string::npos)
        << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "art.json")); // of the first build
    EXPECT_EQ(readText(folder / "art/m1.glb"), compiled.at("m0.glb"));
}

TEST_F(BuildTest, ForgottenOutputsAreNamedAndKept)
{
    writePyramids(2);
    build();
    manifest["assets"].erase(0);
    writeManifest();
    EXPECT_EQ(build()["stale"], nlohmann::json::array({"m0.glb"}));
    EXPECT_EQ(files().size(), 2u);
}

TEST_F(BuildTest, DepfilesAreMakes)
{
    folder.write("a b/m$#1.obj", "mtllib c:1.mtl d.mtl\n" + pyramid(1));
    folder.write("a b/d.mtl", "newmtl red\nKd 1 0 0\n");
    manifest["assets"].push_back({{"name", "x y/z"}, {"source", "a b/m$#1.obj"}});
    writeManifest();
    build();
    const std::string root = at("");
    EXPECT_EQ(readText(folder / "built/x y/z.glb.d"),
              root + "built/x\\ y/z.glb: \\\n  " + root + "manifest.json \\\n  " + root +
                  "a\\ b/m$$\\#1.obj \\\n  " + root + "a\\ b/d.mtl\n");
}

TEST_F(BuildTest, WrongUsageIsTwo)
{
    writePyramids(1);
    const std::string build = "build '" + at("manifest.json") + "'";
    for (const std::string& line : {std::string("build"), build, build + " -o",
                                    build + " -o x --jobs 0", build + " -o x extra"})
        EXPECT_EQ(runProgram(PENUMBRA_ASSETC, line, folder).code, 2) << line;
    folder.write("file", "");
    outcome = runProgram(PENUMBRA_ASSETC, build + " -o '" + at("file") + "'", folder);
    EXPECT_EQ(outcome.code, 1);
    EXPECT_NE(outcome.err.find("cannot create the folder"), std::string::npos) << outcome.err;
}

namespace {

// Two squares on nodes of their own, with the buffer beside the file.
nlohmann::json twoSquares(const TemporaryFolder& folder, double z)
{
    auto square = squareGltf();
    square["buffers"][0]["uri"] = "square.bin";
    const float height = static_cast<float>(z);
    folder.write("square.bin", bytesOf<float>({0, 0, 0, 1, 0, 0, 1, 1, height, 0, 1, 0}) +
                                   bytesOf<std::uint16_t>({0, 1, 2, 0, 2, 3}) +
                                   bytesOf<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}));
    square["meshes"].push_back(square["meshes"][0]);
    square["nodes"] = {{{"name", "left"}, {"mesh", 0}},
                       {{"name", "right"}, {"mesh", 1}, {"translation", {2, 0, 0}}}};
    square["scenes"] = {{{"nodes", {0, 1}}}};
    square["scene"] = 0;
    return square;
}

} // namespace

TEST_F(BuildTest, ScenesAreFoldersOfParts)
{
    manifest["defaults"]["scene"] = manifest["defaults"]["mesh"];
    manifest["assets"] = {{{"name", "a/room"}, {"kind", "scene"}, {"source", "room.gltf"}}};
    writeManifest();
    folder.write("room.gltf", twoSquares(folder, 0).dump());
    const auto first = build();
    ASSERT_EQ(named(first, "built"), Names({"a/room"})) << outcome.err;
    EXPECT_EQ(first["assets"][0]["output"], "a/room/scene.json");
    const nlohmann::json parts = {"a/room/left.glb", "a/room/right.glb"};
    EXPECT_EQ(first["assets"][0]["parts"], parts);
    EXPECT_EQ(first["assets"][0]["compile"]["assets"][0]["field"]["shells"], 3);
    const auto made = files();
    EXPECT_EQ(made.size(), 3u);
    std::size_t bytes = 0;
    for (const auto& [name, content] : made)
        bytes += content.size();
    EXPECT_EQ(first["assets"][0]["bytes"], bytes);
    // As the command writes it.
    const Outcome command = runProgram(
        PENUMBRA_ASSETC,
        fmt::format("bake '{}' -o '{}' --per-node --shells 3 --max-side 5 --directions 32",
                    at("room.gltf"), at("command")),
        folder);
    ASSERT_EQ(command.code, 0) << command.err;
    EXPECT_EQ(readText(folder / "command/scene.json"), made.at("a/room/scene.json"));
    EXPECT_EQ(readText(folder / "command/right.glb"), made.at("a/room/right.glb"));

    const auto second = build();
    EXPECT_EQ(named(second, "unchanged"), Names({"a/room"}));
    EXPECT_EQ(second["assets"][0]["parts"], parts);
    EXPECT_EQ(second["assets"][0]["bytes"], bytes);
    const std::string depfile = readText(folder / "built/a/room/scene.json.d");
    EXPECT_NE(depfile.find("square.bin"), std::string::npos) << depfile;

    std::filesystem::remove(folder / "built/a/room/left.glb"); // a part is an output
    EXPECT_EQ(named(build(), "built"), Names({"a/room"}));
    folder.write("built/a/room/right.glb", "spoilt");
    EXPECT_EQ(named(build(), "built"), Names({"a/room"}));
    EXPECT_EQ(files(), made);
    twoSquares(folder, 0.5); // the buffer
    EXPECT_EQ(named(build(), "built"), Names({"a/room"}));

    auto renamed = twoSquares(folder, 0.5);
    renamed["nodes"][1]["name"] = "east";
    folder.write("room.gltf", renamed.dump());
    EXPECT_EQ(build()["stale"], nlohmann::json::array({"a/room/right.glb"}));
    EXPECT_EQ(build()["stale"], nlohmann::json::array({"a/room/right.glb"}));
    EXPECT_TRUE(std::filesystem::exists(folder / "built/a/room/right.glb"));

    manifest["assets"] = nlohmann::json::array(); // of the parts that were recorded last
    writeManifest();
    EXPECT_EQ(build()["stale"],
              nlohmann::json::array({"a/room/east.glb", "a/room/left.glb", "a/room/scene.json"}));
    EXPECT_NE(outcome.err.find("no asset of the manifest makes a/room/east.glb, a/room/left.glb, "
                               "a/room/scene.json; delete what nothing uses"),
              std::string::npos)
        << outcome.err;
    EXPECT_NE(outcome.err.find("lists no assets"), std::string::npos) << outcome.err;
}

TEST_F(BuildTest, AFolderOfPartsIsTheScenesOwn)
{
    folder.write("room.gltf", twoSquares(folder, 0).dump());
    folder.write("m.obj", pyramid(1));
    manifest["assets"] = {{{"name", "room/deep/left"}, {"source", "m.obj"}},
                          {{"name", "room"}, {"kind", "scene"}, {"source", "room.gltf"}}};
    writeManifest();
    build(1);
    EXPECT_NE(outcome.err.find("assets[0].name lies in the folder of the scene assets[1]"),
              std::string::npos)
        << outcome.err;
    // A part would replace a source.
    folder.write("art/room/left.glb", "x");
    manifest["assets"][0] = {{"name", "m"}, {"source", "art/room/left.glb"}};
    writeManifest();
    build(1, "", "art");
    EXPECT_FALSE(std::filesystem::exists(folder / "art/m.glb"));
    EXPECT_NE(outcome.err.find("would replace the source of assets[0]"), std::string::npos)
        << outcome.err;
    EXPECT_EQ(readText(folder / "art/room/left.glb"), "x");
}

TEST_F(BuildTest, ALightDoesNotReplaceTheMeshThatItNames)
{
    const auto glb = *writeGlb(squareGltf().dump(), {});
    ASSERT_TRUE(writeFile(folder / "art/lamp.glb", std::span<const std::byte>(glb)));
    const std::string mesh = readText(folder / "art/lamp.glb");
    folder.write("art/lamp.json",
                 R"({"version":1,"type":"mesh","source":"lamp.glb","radiance":[1,1,1]})");
    manifest["assets"] = {{{"name", "lamp"}, {"source", "art/lamp.json"}}};
    manifest["defaults"]["light"] = manifest["defaults"]["mesh"];
    writeManifest();
    build(1, "", "art");
    const std::string says = at("art/lamp.glb") + ": the output would replace " +
                             at("art/lamp.glb") + ", which it is made of";
    EXPECT_NE(outcome.err.find(says), std::string::npos) << outcome.err;
    EXPECT_EQ(readText(folder / "art/lamp.glb"), mesh);
    const Outcome command = runProgram(PENUMBRA_ASSETC,
                                       fmt::format("light '{}' -o '{}' --shells 3 --max-side 5",
                                                   at("art/lamp.json"), at("art/lamp.glb")),
                                       folder);
    EXPECT_EQ(command.code, 2);
    EXPECT_NE(command.err.find(says), std::string::npos) << command.err;
    EXPECT_EQ(readText(folder / "art/lamp.glb"), mesh);
}

// Scripts write sources and build at once: that is no change during the build.
TEST_F(BuildTest, SourcesWrittenThisMomentAreKnownAgain)
{
    manifest["assets"] = {{{"name", "new"}, {"source", "new.obj"}}};
    writeManifest();
    for (int round = 0; round < 10; ++round) {
        folder.write("new.obj", pyramid(round + 1));
        EXPECT_EQ(named(build(), "built"), Names({"new"}));
        EXPECT_EQ(outcome.err.find("changed while"), std::string::npos) << outcome.err;
        EXPECT_EQ(named(build(), "unchanged"), Names({"new"}));
    }
    folder.write("new.obj", pyramid(1));
    const std::int64_t tick = waitForFileTick();
    EXPECT_NE(fingerprintFile(folder / "new.obj", tick).stamp, kAnyFile);
    folder.write("new.obj", pyramid(2));
    EXPECT_EQ(fingerprintFile(folder / "new.obj", tick).stamp, kAnyFile);
}

// JSON cannot hold them as they are; the record does.
TEST_F(BuildTest, NamesNeedNotBeUtf8)
{
    for (const char* name : {"\xff.mtl", "a%ff.mtl"})
        folder.write(name, "newmtl red\nKd 1 0 0\n");
    folder.write("m.obj",
                 std::string("mtllib \xff.mtl\nmtllib a%ff.mtl\nusemtl red\n") + pyramid(1));
    manifest["assets"] = {{{"name", "m"}, {"source", "m.obj"}}};
    writeManifest();
    EXPECT_EQ(named(build(), "built"), Names({"m"})) << outcome.err;
    EXPECT_EQ(named(build(), "unchanged"), Names({"m"}));
    folder.write("\xff.mtl", "newmtl red\nKd 0 1 0\n");
    EXPECT_EQ(named(build(), "built"), Names({"m"}));
}

} // namespace penumbra
