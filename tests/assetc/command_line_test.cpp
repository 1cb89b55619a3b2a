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
          bake + " --report ''", "bake '' -o " + at("o.glb"), "build " + at("m.json") + " -o ''",
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
}

TEST_F(CommandLine, ValidateListsAChecksumThatIsNoTextOnce)
{
    folder.write("square.gltf", squareGltf().dump());
    ASSERT_EQ(run("bake " + at("square.gltf") + " -o " + at("a.glb") + quick).code, 0);
    std::string bytes = readText(folder / "a.glb");
    const std::size_t begin = bytes.find("\"geometryChecksum\":\"") + 19;
    ASSERT_EQ(bytes[begin], '"');
    bytes.replace(begin, 18, "123456789012345678");
    folder.write("bad.glb", bytes);
    const Outcome outcome = run("validate " + at("bad.glb"));
    EXPECT_EQ(outcome.code, 1);
    EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 2) << outcome.out;
}

TEST_F(CommandLine, InspectAndValidateTellFilesByTheirContent)
{
    auto square = squareGltf();
    const auto gltf = square.dump();
    const std::string sky = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n" +
                            std::string("\x80\x40\x20\x81\x80\x40\x20\x81", 8);
    folder.write("a.gltf", gltf);
    folder.write("a.obj", "# a triangle\nmtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder.write("b.hdr", sky);
    folder.write("m.json", R"({"version":1,"assets":[{"name":"a","source":"a.obj"}]})");
    ASSERT_EQ(run("bake " + at("a.gltf") + " -o " + at("a.glb") + " --no-field").code, 0);
    ASSERT_EQ(run("environment " + at("b.hdr") + " -o " + at("b.env")).code, 0);
    std::filesystem::copy_file(folder / "a.glb", folder / "compiled.bin");
    std::filesystem::copy_file(folder / "b.env", folder / "b.glb");
    for (const auto& [name, type, says] :
         {std::tuple{"a.gltf", "mesh source", "compile it with assetc bake"},
          {"a.obj", "mesh source", "a.mtl: missing"},
          {"b.hdr", "environment source", "compile it with assetc environment"},
          {"m.json", "manifest", "1 mesh"},
          {"a.glb", "mesh", "4 vertices"},
          {"compiled.bin", "mesh", "4 vertices"},
          {"b.env", "environment", "2x1"},
          {"b.glb", "environment", "2x1"}}) {
        const Outcome human = run(std::string("inspect ") + at(name));
        EXPECT_EQ(human.code, 0) << name << human.err;
        EXPECT_NE(human.out.find(says), std::string::npos) << human.out;
        EXPECT_EQ(nlohmann::json::parse(run("inspect --json " + at(name)).out)["type"], type);
        EXPECT_EQ(run("validate " + at(name)).code, 0) << name;
        EXPECT_EQ(nlohmann::json::parse(run("validate --json " + at(name)).out)["valid"], true);
    }
    folder.write("bad.obj", "v 0 0 0\nv 1 0 zero\n");
    folder.write("bad.json", R"({"version":1,"assets":[{"name":"a"},{"name":"b"}]})");
    EXPECT_NE(run("validate " + at("bad.obj")).out.find("bad.obj: line 2"), std::string::npos);
    const auto bad = nlohmann::json::parse(run("validate --json " + at("bad.json")).out);
    EXPECT_EQ(bad["valid"], false);
    EXPECT_EQ(bad["problems"].size(), 2u);
}

TEST_F(CommandLine, WrongKindsOfFileAreNamed)
{
    folder.write("png.glb", "\x89PNG\r\n\x1a\n....");
    folder.write("sky.exr", "\x76\x2f\x31\x01....");
    folder.write("scene.fbx", "Kaydara FBX Binary  ....");
    folder.write("empty.glb", "");
    folder.write("cut.glb", "glTF....");
    folder.write("lamp.json", R"({"version":1,"type":"sphere","radius":1,"power":[1,1,1]})");
    folder.write("dust.obj", "v 0 0 0\nv 1e-7 0 0\nv 0 1e-7 0\nf 1 2 3\n");
    folder.write("what.dat", "\x01\x02\x03");
    folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    for (const auto& [command, says] :
         {std::pair{"inspect " + at("png.glb"), "a PNG picture"},
          {"inspect " + at("scene.fbx"), "an FBX scene; export it as glTF"},
          {"inspect " + at("empty.glb"), "an empty file"},
          {"inspect " + at("what.dat"), "no file that assetc knows"},
          {"bake " + at("sky.exr") + " -o " + at("o.glb"),
           "an OpenEXR picture; compile it with assetc environment"},
          {"bake " + at("png.glb") + " -o " + at("o.glb"), "a PNG picture"},
          {"bake " + at("lamp.json") + " -o " + at("o.glb"),
           "a light description; compile it with assetc light"},
          {"build " + at("cut.glb") + " -o " + at("o"),
           "an unreadable binary glTF file: 8 bytes: cut in its header"},
          {"build " + at("lamp.json") + " -o " + at("o"), "compile it with assetc light"},
          {"light " + at("a.obj") + " -o " + at("o.glb"),
           "a Wavefront OBJ mesh; compile it with assetc bake"},
          {"bake " + at("dust.obj") + " -o " + at("o.glb"), "scale it, its unit is the metre"},
          {"environment " + at("a.obj") + " -o " + at("o.env"),
           "a Wavefront OBJ mesh; compile it with assetc bake"}}) {
        const Outcome outcome = run(command);
        EXPECT_EQ(outcome.code, 1) << command;
        EXPECT_NE(outcome.err.find(says), std::string::npos) << outcome.err;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    }
}

TEST_F(CommandLine, InspectAndValidateReadWhatPeopleAndAssetcWrite)
{
    folder.write("a.gltf", squareGltf().dump());
    folder.write("sky.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n" +
                                std::string("\x80\x40\x20\x81\x80\x40\x20\x81", 8));
    folder.write("lamp.json", R"({"version":1,"type":"mesh","source":"a.gltf","power":[1,2,3]})");
    folder.write("m.json", R"({"version":1,"assets":[{"name":"sky","source":"sky.hdr"}]})");
    const std::string report = " --report ";
    ASSERT_EQ(run("bake " + at("a.gltf") + " -o " + at("parts") + " --per-node --no-field" +
                  report + at("r1.json"))
                  .code,
              0);
    ASSERT_EQ(
        run("bake " + at("a.gltf") + " -o " + at("a.glb") + " --no-field" + report + at("r2.json"))
            .code,
        0);
    ASSERT_EQ(
        run("light " + at("lamp.json") + " -o " + at("l.glb") + quick + report + at("r3.json"))
            .code,
        0);
    ASSERT_EQ(
        run("environment " + at("sky.hdr") + " -o " + at("s.env") + report + at("r4.json")).code,
        0);
    ASSERT_EQ(run("build " + at("m.json") + " -o " + at("built") + report + at("r5.json")).code, 0);
    ASSERT_EQ(run("validate " + at("a.glb") + report + at("r6.json")).code, 0);
    ASSERT_EQ(run("inspect " + at("a.glb") + report + at("r7.json")).code, 0);
    for (const auto& [name, type, what, says] :
         {std::tuple{"lamp.json", "light description", "a light description", "a.gltf"},
          {"parts/scene.json", "scene", "a scene of parts", "1 with a mesh"},
          {"r1.json", "report", "a report of assetc bake", "report"},
          {"r2.json", "report", "a report of assetc bake", "report"},
          {"r3.json", "report", "a report of assetc light", "report"},
          {"r4.json", "report", "a report of assetc environment", "report"},
          {"r5.json", "report", "a report of assetc build", "report"},
          {"r6.json", "report", "a report of assetc validate", "report"},
          {"r7.json", "report", "a report of assetc inspect", "report"}}) {
        const Outcome human = run(std::string("inspect ") + at(name) + report + at("i.json"));
        EXPECT_EQ(human.code, 0) << name << human.err;
        EXPECT_NE(human.out.find(says), std::string::npos) << name << human.out;
        EXPECT_EQ(nlohmann::json::parse(readText(folder / "i.json"))["type"], type) << name;
        EXPECT_EQ(readText(folder / "i.json"), run("inspect --json " + at(name)).out);
        EXPECT_EQ(run("validate " + at(name)).code, 0) << name;
        EXPECT_EQ(nlohmann::json::parse(run("validate --json " + at(name)).out)["what"], what);
    }
    EXPECT_EQ(run("inspect " + at("a.glb") + report + at("a.glb")).code, 2);
    EXPECT_EQ(run("validate " + at("lamp.json") + report + at("lamp.json")).code, 2);
}

TEST_F(CommandLine, ValidateChecksLightsAndScenesAsTheirReadersDo)
{
    const std::string place = R"("Transform":{"position":[0,0,0],"rotation":[0,0,0,1],"scale":1})";
    const std::string start = R"({"version":1,"entities":[)";
    for (const auto& [text, says] : std::vector<std::pair<std::string, std::string>>{
             {R"({"version":1,"type":"sphere","radius":1})", "it needs exactly one"},
             {R"({"version":1,"type":"cone","power":[1,1,1]})", "is \"cone\", not one of sphere"},
             {R"({"version":1,"entities":{}})", "entities is an object, not an array"},
             {start + R"({"Name":{"value":"a"}}]})", "entities[0] has no \"Transform\""},
             {start + "{" + place + R"(,"Parent":{"entity":0}}]})", "is no earlier entity"},
             {start + "{" + place + R"(,"MeshInstance":{"asset":"a.glb"}}]})",
              "entities[0].MeshInstance.asset names a file"},
             {start + "{" + place + R"(,"MeshInstance":{"asset":"../a.glb"}}]})",
              "not a plain path"},
             {start + R"({"Transform":{"position":[0,0],"rotation":[0,0,0,1],"scale":1}}]})",
              "position does not have 3 numbers"},
             {start + R"({"Transform":{"position":[0,0,0],"rotation":[0,0,0,2],"scale":1}}]})",
              "rotation"},
             {start + "{" + place + R"(}],"lights":[{"entity":1,"type":"point","intensity":1}]})",
              "lights[0].entity is none of the 1 entities"},
             {R"({"version":2,"entities":[]})", "version is 2, this program reads 1"}}) {
        folder.write("x.json", text);
        const Outcome outcome = run("validate " + at("x.json") + " --report " + at("r.json"));
        EXPECT_EQ(outcome.code, 1) << text;
        EXPECT_NE(outcome.out.find(says), std::string::npos) << text << outcome.out;
        const auto report = nlohmann::json::parse(readText(folder / "r.json"));
        EXPECT_EQ(report["valid"], false);
        EXPECT_GE(report["problems"].size(), 1u) << outcome.out;
        EXPECT_EQ(run("inspect " + at("x.json") + " --report " + at("none.json")).code, 1);
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "none.json"));
}

TEST_F(CommandLine, WrongCommandsAreNamed)
{
    for (const auto& [word, says] :
         {std::pair{"bak", "\"bak\" is not a command; did you mean bake?"},
          {"biuld", "did you mean build?"},
          {"fry", "\"fry\" is not a command; known: bake"}}) {
        const Outcome outcome = run(word);
        EXPECT_EQ(outcome.code, 2);
        EXPECT_NE(outcome.err.find(says), std::string::npos) << outcome.err;
    }
}

} // namespace penumbra
