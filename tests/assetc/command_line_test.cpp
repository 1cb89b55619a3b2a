// The contract of the command line: exit codes, one clear message, nothing half-written.
#include "tests/assetc/gltf_fixture.h"
#include "tests/support/program.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace penumbra {

namespace {

class CommandLine : public testing::Test {
protected:
    Outcome run(const std::string& arguments) const
    {
        return runProgram(PENUMBRA_ASSETC, arguments, folder);
    }
    [[nodiscard]] std::string at(const std::string& name) const
    {
        return fmt::format("'{}'", (folder / name).string());
    }

    TemporaryFolder folder;
    const std::string quick = " --shells 4 --max-side 5 --directions 64 ";
};

} // namespace

TEST_F(CommandLine, BakeInspectValidate)
{
    folder.write("square.gltf", squareGltf().dump());
    const Outcome bake = run("bake " + at("square.gltf") + " -o " + at("new/square.glb") + quick +
                             "--verify --jobs 2 --report " + at("report.json"));
    ASSERT_EQ(bake.code, 0) << bake.err;
    const auto report = nlohmann::json::parse(readText(folder / "report.json"));
    EXPECT_EQ(report["vertices"], 4);
    EXPECT_EQ(report["field"]["shells"], 4);
    EXPECT_TRUE(report["verify"].contains("rms"));

    EXPECT_NE(run("inspect " + at("new/square.glb")).out.find("4 vertices"), std::string::npos);
    EXPECT_EQ(nlohmann::json::parse(run("inspect --json " + at("new/square.glb")).out)["triangles"],
              2);
    EXPECT_EQ(run("validate " + at("new/square.glb")).code, 0);
    EXPECT_EQ(nlohmann::json::parse(run("validate --json " + at("new/square.glb")).out)["valid"],
              true);

    const Outcome bare = run("bake " + at("square.gltf") + " -o " + at("bare.glb") + " --no-field");
    EXPECT_EQ(bare.code, 0) << bare.err;
    EXPECT_FALSE(
        nlohmann::json::parse(run("inspect --json " + at("bare.glb")).out).contains("field"));
}

TEST_F(CommandLine, WrongUsageIsTwo)
{
    folder.write("square.gltf", squareGltf().dump());
    const std::string bake = "bake " + at("square.gltf") + " -o " + at("o.glb");
    for (const std::string& arguments :
         {std::string(), std::string("fry"), std::string("bake"), "bake " + at("square.gltf"),
          bake + " --shells 1", bake + " --shells x", bake + " --max-side 64",
          bake + " --directions 63", bake + " --directions 0", bake + " --jobs 0",
          bake + " --threshold -1", bake + " --verify --no-field", bake + " extra",
          "bake " + at("square.gltf") + " -o " + at("o.gltf"), std::string("inspect"),
          std::string("validate --what x")}) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, 2) << arguments << "\n" << outcome.err;
        EXPECT_FALSE(outcome.err.empty()) << arguments;
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "o.glb"));
    EXPECT_EQ(run("--help").code, 0);
    EXPECT_EQ(run("bake --help").code, 0);
}

TEST_F(CommandLine, OutputMayNotReplaceTheInput)
{
    folder.write("a.glb", "x");
    EXPECT_EQ(run("bake " + at("a.glb") + " -o " + at("a.glb")).code, 2);
    EXPECT_EQ(readText(folder / "a.glb"), "x");
}

TEST_F(CommandLine, BadInputIsOne)
{
    folder.write("bad.glb", "not glTF");
    folder.write("mesh.stl", "solid");
    folder.write("map.hdr", "not a map");
    for (const std::string& arguments :
         {"bake " + at("missing.glb") + " -o " + at("o.glb"),
          "bake " + at("bad.glb") + " -o " + at("o.glb"),
          "bake " + at("mesh.stl") + " -o " + at("o.glb"),
          "environment " + at("map.hdr") + " -o " + at("o.env"), "inspect " + at("bad.glb"),
          "inspect " + at("missing.glb"), "inspect " + at("bad.env")}) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, 1) << arguments;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "o.glb"));
    EXPECT_FALSE(std::filesystem::exists(folder / "o.env"));
}

TEST_F(CommandLine, ValidateListsEveryProblem)
{
    folder.write("square.gltf", squareGltf().dump());
    ASSERT_EQ(run("bake " + at("square.gltf") + " -o " + at("a.glb") + quick).code, 0);
    std::string bytes = readText(folder / "a.glb"); // spoilt in two places, at equal length
    for (const auto& [from, to] : {std::pair<std::string, std::string>{"\"sh4\"", "\"sh9\""},
                                   {"\"occlusion\"", "\"confusion\""}}) {
        ASSERT_NE(bytes.find(from), std::string::npos);
        bytes.replace(bytes.find(from), from.size(), to);
    }
    folder.write("bad.glb", bytes);
    const Outcome outcome = run("validate --json " + at("bad.glb"));
    EXPECT_EQ(outcome.code, 1);
    const auto report = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(report["valid"], false);
    EXPECT_EQ(report["problems"].size(), 2u) << outcome.out;
    EXPECT_EQ(run("validate " + at("missing.glb")).code, 1);
    EXPECT_EQ(nlohmann::json::parse(run("validate --json " + at("missing.glb")).out)["valid"],
              false);
    EXPECT_EQ(run("validate " + at("square.gltf")).code, 1); // not compiled
}

} // namespace penumbra
