// Where assetc writes is checked before it works, and nothing but its own is replaced.
#include "tests/assetc/build_fixture.h"

#include <unistd.h>

namespace penumbra {

namespace {

class Outputs : public testing::Test {
protected:
    Outputs()
    {
        folder.write("square.gltf", squareGltf().dump());
        folder.write("lamp.json", kLamp);
        folder.write("notes.json", "mine");
        folder.write("file", "");
        std::filesystem::create_directories(folder / "folder.glb");
        std::filesystem::create_directories(folder / "folder.json");
    }

    Outcome run(const std::string& arguments) const
    {
        return runProgram(PENUMBRA_ASSETC, arguments, folder);
    }
    [[nodiscard]] std::string at(const std::string& name) const
    {
        return fmt::format("'{}'", (folder / name).string());
    }

    static constexpr const char* kLamp =
        R"({"version":1,"type":"sphere","radius":0.1,"power":[40,36,30]})";
    TemporaryFolder folder;
    const std::string quick = " --shells 4 --max-side 5 --directions 64 ";
};

} // namespace

// No source is there: what is said of the output was known before it was opened.
TEST_F(Outputs, AreCheckedBeforeTheSourceIsOpened)
{
    for (const auto& [arguments, code, says] :
         {std::tuple{"bake none.obj -o " + at("folder.glb"), 1,
                     "folder.glb: a folder; name a file"},
          {"light none.json -o " + at("folder.glb"), 1, "folder.glb: a folder; name a file"},
          {"bake none.obj -o " + at("file/o.glb"), 1, "file is no folder; choose another name"},
          {"bake none.obj -o " + at("file/new/o.glb"), 1, "file is no folder; choose another name"},
          {"environment none.hdr -o " + at("file/o.env"), 1, "file is no folder"},
          {"bake none.obj --per-node -o " + at("file/o"), 1, "file is no folder"},
          {"bake none.obj --per-node -o " + at("O.GLB"), 2, "is a folder; name one"},
          {"inspect none.glb --png " + at("file/o.png"), 1, "file is no folder"},
          {"bake none.obj -o " + at("o.glb") + " --report " + at("folder.json"), 1,
           "a folder; name"},
          {"bake none.obj -o " + at("o.glb") + " --report " + at("lamp.json"), 2,
           "lamp.json: is a light description, and the report would replace it; choose another"},
          {"validate none.glb --report " + at("lamp.json"), 2, "the report would replace it"},
          {"build none.json -o " + at("o") + " --report " + at("lamp.json"), 2, "would replace it"},
          {"light none.json -o " + at("o.glb") + " --report " + at("notes.json"), 2,
           "notes.json: is no report of assetc, and the report would replace it"}}) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, code) << arguments << outcome.err;
        EXPECT_NE(outcome.err.find(says), std::string::npos) << arguments << outcome.err;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    }
    EXPECT_EQ(readText(folder / "lamp.json"), kLamp);
    EXPECT_EQ(readText(folder / "notes.json"), "mine");
    EXPECT_FALSE(std::filesystem::exists(folder / "o"));
}

TEST_F(Outputs, AFolderThatCannotBeWrittenIsNamed)
{
    using std::filesystem::perms;
    constexpr perms kReadOnly = perms(0555);
    std::filesystem::permissions(folder / "folder.glb", kReadOnly);
    std::string program = PENUMBRA_ASSETC;
    std::string arguments = "bake none.obj -o " + at("folder.glb/o.glb");
    if (::geteuid() ==
        0) { // may write anywhere: nobody runs a copy, from a folder that all may read
        std::filesystem::permissions(folder / "", perms(0755));
        std::filesystem::copy_file(program, folder / "assetc");
        arguments = "--reuid=65534 --regid=65534 --clear-groups " + at("assetc") + " " + arguments;
        program = "setpriv";
    }
    const Outcome outcome = runProgram(program, arguments, folder);
    EXPECT_EQ(outcome.code, 1) << outcome.err;
    EXPECT_NE(outcome.err.find("choose another folder"), std::string::npos) << outcome.err;
}

TEST_F(Outputs, AnOldReportIsNotLeftToAFailure)
{
    const std::string report = " --report " + at("r.json"), output = " -o " + at("o.glb");
    ASSERT_EQ(run("bake " + at("square.gltf") + output + quick + report).code, 0);
    ASSERT_TRUE(std::filesystem::exists(folder / "r.json"));
    EXPECT_EQ(run("bake none.obj" + output + report).code, 1);
    EXPECT_FALSE(std::filesystem::exists(folder / "r.json"));
    ASSERT_EQ(run("light " + at("lamp.json") + output + quick + report).code, 0);
    EXPECT_EQ(run("inspect " + at("file") + report).code, 1);
    EXPECT_FALSE(std::filesystem::exists(folder / "r.json"));
    folder.write("empty.json", ""); // as mktemp leaves it
    EXPECT_EQ(run("bake none.obj" + output + " --report " + at("empty.json")).code, 1);
    EXPECT_TRUE(std::filesystem::exists(folder / "empty.json"));
    EXPECT_EQ(run("validate " + at("o.glb") + " --report " + at("empty.json")).code, 0);
    EXPECT_NE(readText(folder / "empty.json"), "");
}

TEST_F(Outputs, EndingsCountInAnyCase)
{
    EXPECT_EQ(run("bake " + at("square.gltf") + " -o " + at("o.GLB") + quick + " --report " +
                  at("r.JSON"))
                  .code,
              0);
    EXPECT_EQ(run("validate " + at("o.GLB")).code, 0);
}

// As on a full disk.
TEST_F(Outputs, AWriteThatFailsLeavesNothing)
{
    const Outcome outcome =
        runProgram("sh",
                   fmt::format("-c \"ulimit -f 1; '{}' bake {} -o {} {}\"", PENUMBRA_ASSETC,
                               at("square.gltf"), at("new/o.glb"), quick),
                   folder);
    EXPECT_EQ(outcome.code, 1) << outcome.err;
    EXPECT_NE(outcome.err.find("o.glb: cannot write: File too large"), std::string::npos)
        << outcome.err;
    EXPECT_TRUE(std::filesystem::is_empty(folder / "new"));
}

TEST_F(BuildTest, WatchingEndsWhereNothingCanBeWritten)
{
    writePyramids(1);
    folder.write("file", "");
    for (const std::string& more :
         {"-o '" + at("file") + "'",
          "-o '" + at("built") + "' --report '" + at("manifest.json") + "'"}) {
        outcome = runProgram("timeout",
                             fmt::format("20 '{}' build '{}' --watch {}", PENUMBRA_ASSETC,
                                         at("manifest.json"), more),
                             folder);
        EXPECT_EQ(outcome.code, more.find("report") == std::string::npos ? 1 : 2) << outcome.err;
    }
}

TEST_F(BuildTest, TheReportReplacesNoOutput)
{
    folder.write("room.gltf", squareGltf().dump());
    manifest["assets"] = {{{"name", "room"}, {"kind", "scene"}, {"source", "room.gltf"}}};
    writeManifest();
    outcome = runProgram(PENUMBRA_ASSETC,
                         fmt::format("build '{}' -o '{}' --report '{}'", at("manifest.json"),
                                     at("made"), at("made/room/scene.json")),
                         folder);
    EXPECT_EQ(outcome.code, 1);
    EXPECT_NE(outcome.err.find("assets[0].name: the output"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("would replace the report"), std::string::npos) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "made"));
}

// Before the others are built: of the assets that fail so, each is listed.
TEST_F(BuildTest, AnOutputThatCannotBeIsSaidBeforeItIsCompiled)
{
    writePyramids(2);
    std::filesystem::create_directories(folder / "built/m1.glb");
    const auto report = build(1);
    EXPECT_EQ(named(report, "built"), Names({"m0"}));
    EXPECT_NE(outcome.err.find("m1.glb: a folder; name a file in it"), std::string::npos)
        << outcome.err;
    EXPECT_EQ(report["assets"][1]["seconds"], 0);
}

} // namespace penumbra
