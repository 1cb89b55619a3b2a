// What assetc says to a person: one line that names the file, the place and the way out, the same
// from every command.
#include "assets/glb.h"
#include "tests/assetc/gltf_fixture.h"
#include "tests/support/program.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace penumbra {

namespace {

class Messages : public testing::Test {
protected:
    Messages()
    {
        folder.write("square.gltf", squareGltf().dump());
        folder.write("lamp.json",
                     R"({"version":1,"type":"sphere","radius":0.1,"power":[40,36,30]})");
    }

    Outcome run(const std::string& arguments) const
    {
        return runProgram(PENUMBRA_ASSETC, arguments, folder);
    }
    [[nodiscard]] std::string at(const std::string& name) const
    {
        return fmt::format("'{}'", (folder / name).string());
    }
    void bake(const std::string& output, const std::string& more = "") const
    {
        const Outcome done = run("bake " + at("square.gltf") + " -o " + at(output) + quick + more);
        ASSERT_EQ(done.code, 0) << done.err;
    }
    // "FOLDER/name: says" without the program's name, from stderr or stdout.
    [[nodiscard]] std::string firstLine(const std::string& text) const
    {
        const std::string start = "assetc: error: ";
        const std::string line = text.substr(0, text.find('\n'));
        return line.starts_with(start) ? line.substr(start.size()) : line;
    }

    TemporaryFolder folder;
    const std::string quick = " --shells 4 --max-side 5 --directions 64 ";
};

std::size_t linesOf(const std::string& text)
{
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

} // namespace

TEST_F(Messages, ABadFileHasOneStory)
{
    bake("whole.glb");
    const std::string whole = readText(folder / "whole.glb");
    folder.write("cut.glb", whole.substr(0, 500));
    folder.write("text.glb", "not glTF");
    folder.write("text.obj", "no mesh");
    folder.write("blank.obj", " \n");
    folder.write("empty.glb", "");
    folder.write("half.gltf", "{\"asset\": ");
    folder.write("cut.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n1234");
    folder.write("cut.exr", "\x76\x2f\x31\x01...");
    folder.write("sky.png", "\x89PNG\r\n\x1a\n....");
    std::filesystem::create_directory(folder / "folder.glb");
    for (const auto& [name, command, says] :
         {std::tuple{"cut.glb", "bake", "header says"},
          {"cut.glb", "light", "header says"},
          {"text.glb", "bake", "no file that assetc knows; it reads"},
          {"text.glb", "environment", "no file that assetc knows; it reads"},
          {"text.obj", "bake", "no triangles"},
          {"blank.obj", "bake", "no triangles"},
          {"empty.glb", "bake", "an empty file; write it again"},
          {"empty.glb", "environment", "an empty file; write it again"},
          {"half.gltf", "bake", "not valid JSON at line 1"},
          {"cut.hdr", "environment", "row 0 of 4 is damaged or cut; copy or save it again"},
          {"cut.exr", "environment", "the file is cut in its header; copy or save it again"},
          {"sky.png", "bake", "a PNG picture; "},
          {"folder.glb", "bake", "a folder; name a file in it"},
          {"folder.glb", "light", "a folder; name a file in it"}}) {
        const std::string output =
            command == std::string("environment") ? at("o.env") : at("o.glb");
        const Outcome compiled = run(std::string(command) + " " + at(name) + " -o " + output);
        const Outcome checked = run(std::string("validate ") + at(name));
        EXPECT_EQ(compiled.code, 1) << name;
        EXPECT_EQ(checked.code, 1) << name;
        EXPECT_NE(compiled.err.find(says), std::string::npos) << compiled.err;
        EXPECT_EQ(linesOf(compiled.err), 1u) << compiled.err;
        EXPECT_EQ(firstLine(compiled.err), firstLine(checked.out + checked.err)) << name;
    }
}

TEST_F(Messages, AByteOrderMarkChangesNothing)
{
    folder.write("mark.gltf", "\xef\xbb\xbf" + squareGltf().dump());
    EXPECT_EQ(run("validate " + at("mark.gltf")).code, 0);
    EXPECT_EQ(run("bake " + at("mark.gltf") + " -o " + at("o.glb") + " --no-field").code, 0);
}

TEST_F(Messages, CompiledFilesAreNoSources)
{
    bake("square.glb");
    bake("parts", "--per-node");
    folder.write("sky.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n" +
                                std::string("\x80\x40\x20\x81\x80\x40\x20\x81", 8));
    ASSERT_EQ(run("environment " + at("sky.hdr") + " -o " + at("sky.env")).code, 0);
    ASSERT_EQ(run("light " + at("lamp.json") + " -o " + at("lamp.glb") + quick).code, 0);
    const std::string before = readText(folder / "square.glb");
    for (const auto& [command, name, what] :
         {std::tuple{"bake", "square.glb", "a compiled mesh"},
          {"bake", "lamp.glb", "a compiled light"},
          {"bake", "sky.env", "a compiled environment"},
          {"bake", "parts/scene.json", "a scene of parts"},
          {"light", "square.glb", "a compiled mesh"},
          {"environment", "sky.env", "a compiled environment"}}) {
        const std::string output =
            command == std::string("environment") ? at("o.env") : at("o.glb");
        const Outcome refused = run(std::string(command) + " " + at(name) + " -o " + output);
        EXPECT_EQ(refused.code, 1) << name;
        EXPECT_NE(refused.err.find(std::string(what) + "; it is no source: use it as it is, or "
                                                       "compile what it was made from"),
                  std::string::npos)
            << refused.err;
        EXPECT_EQ(run(std::string("validate ") + at(name)).out,
                  fmt::format("{}: valid: {}\n", (folder / name).string(), what));
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "o.glb"));
    std::string old = before;
    const std::size_t version = old.find("\"version\":\"1.3\"");
    ASSERT_NE(version, std::string::npos);
    folder.write("old.glb", old.replace(version, 9, "\"vorsion\""));
    EXPECT_NE(
        run("validate " + at("old.glb")).out.find("has no \"version\"; compile the asset again"),
        std::string::npos);
}

TEST_F(Messages, WrongUsageIsOneLine)
{
    const std::string bake = "bake " + at("square.gltf") + " -o " + at("o.glb");
    for (const auto& [arguments, says] : std::vector<std::pair<std::string, std::string>>{
             {"", "no command; see assetc --help"},
             {"--nope", "no option --nope; see assetc --help"},
             {"bake", "bake: IN is required; see assetc bake --help"},
             {bake + " --lods abc", "--lods: \"abc\" is not a whole number from 0 to 4; see"},
             {bake + " --lods 5", "--lods: \"5\" is not a whole number from 0 to 4; see"},
             {bake + " --lods 2.5", "\"2.5\" is not a whole number"},
             {bake + " --lod 3", "no option --lod; did you mean --lods?; see assetc bake --help"},
             {bake + " --threshold nan", "\"nan\" is not a number from 0 to 1"},
             {bake + " --max-side 64", "\"64\" is not a number 2^k + 1 from 3 to 257"},
             {bake + " --directions 63", "\"63\" is not an even number from 2 to 65536"},
             {bake + " more", "\"more\" is one argument too many"},
             {bake + " --target-error 0.1 --shells 4",
              "bake: --target-error beside --shells, which it picks itself; leave out one; see"},
             {bake + " --verify --no-field",
              "--verify beside --no-field, which leaves no field to measure; leave out one"},
             {bake + " --jobs 1 --jobs 2", "bake: --jobs is given 2 times; give it once; see"},
             {bake + " --jobs", "bake: --jobs takes a value; give one; see"},
             {bake + " -o " + at("p.glb"), "--output is given 2 times; give it once"},
             {"light " + at("lamp.json") + " -o " + at("l.glb") + " --lods 2",
              "no option --lods; that is one of assetc bake; see"},
             {"light " + at("lamp.json") + " -o " + at("l.glb") + " --shels 2",
              "did you mean --shells?"}}) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, 2) << arguments;
        EXPECT_TRUE(outcome.err.starts_with("assetc: error: ")) << outcome.err;
        EXPECT_NE(outcome.err.find(says), std::string::npos) << outcome.err;
        EXPECT_EQ(linesOf(outcome.err), 1u) << outcome.err;
        EXPECT_EQ(outcome.out, "");
    }
    const Outcome version = run("--version");
    EXPECT_EQ(version.code, 0);
    EXPECT_TRUE(version.out.starts_with("assetc 0.")) << version.out;
}

TEST_F(Messages, OutputsReplaceNothingThatTheyAreMadeOf)
{
    auto square = squareGltf();
    const std::string uri = square["buffers"][0]["uri"];
    folder.write("buffer.bin", bytesOf<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}) +
                                   bytesOf<std::uint16_t>({0, 1, 2, 0, 2, 3}) +
                                   bytesOf<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}));
    for (const char* name : {"in/node_0.glb", "in/data.json"})
        std::filesystem::create_directory(folder / "in"),
            std::filesystem::copy_file(folder / "buffer.bin", folder / name);
    const std::string bytes = readText(folder / "buffer.bin");
    square["buffers"][0]["uri"] = "node_0.glb";
    folder.write("in/a.gltf", square.dump());
    square["buffers"][0]["uri"] = "data.json";
    folder.write("in/b.gltf", square.dump());
    for (const std::string& arguments :
         {"bake " + at("in/a.gltf") + " -o " + at("in/node_0.glb") + quick,
          "bake " + at("in/a.gltf") + " -o " + at("in") + " --per-node" + quick,
          "bake " + at("in/b.gltf") + " -o " + at("o.glb") + quick + "--report " +
              at("in/data.json"),
          "bake " + at("in/b.gltf") + " -o " + at("o") + " --per-node --report " +
              at("in/data.json") + quick}) {
        const Outcome refused = run(arguments);
        EXPECT_EQ(refused.code, 2) << arguments << refused.err;
        EXPECT_NE(refused.err.find("would replace"), std::string::npos) << refused.err;
    }
    EXPECT_EQ(readText(folder / "in/node_0.glb"), bytes);
    EXPECT_EQ(readText(folder / "in/data.json"), bytes);
    EXPECT_FALSE(std::filesystem::exists(folder / "o.glb"));
    EXPECT_FALSE(std::filesystem::exists(folder / "o"));
}

TEST_F(Messages, BakeSaysWhatItMeasured)
{
    const Outcome parts = run("bake " + at("square.gltf") + " -o " + at("parts") +
                              " --per-node --verify --report " + at("r.json") + quick);
    ASSERT_EQ(parts.code, 0) << parts.err;
    EXPECT_NE(parts.out.find(".glb: verify: 512 samples"), std::string::npos) << parts.out;
    EXPECT_NE(parts.out.find("scene.json and 1 asset of"), std::string::npos) << parts.out;
    const auto report = nlohmann::json::parse(readText(folder / "r.json"));
    EXPECT_TRUE(report["assets"][0]["verify"].contains("rms"));

    const Outcome target =
        run("bake " + at("square.gltf") + " -o " + at("t.glb") + " --target-error 0.2 --verify");
    ASSERT_EQ(target.code, 0) << target.err;
    const std::size_t trial = target.out.find("target: "), verify = target.out.find("verify: ");
    EXPECT_LT(trial, verify) << target.out;
    EXPECT_LT(verify, target.out.find("t.glb: 4 vertices, 2 triangles, 1 cluster,")) << target.out;
    EXPECT_NE(target.out.find("bytes unpacked"), std::string::npos) << target.out;
}

TEST_F(Messages, PicturesOfWhatHasNone)
{
    bake("parts", "--per-node");
    ASSERT_EQ(run("light " + at("lamp.json") + " -o " + at("lamp.glb") + quick).code, 0);
    const Outcome scene = run("inspect " + at("parts/scene.json") + " --png " + at("s.png"));
    EXPECT_EQ(scene.code, 1);
    EXPECT_NE(scene.err.find("name one of its parts"), std::string::npos) << scene.err;
    EXPECT_EQ(scene.err.find("compile it first"), std::string::npos) << scene.err;
    // A light has no row of errors.
    const Outcome light = run("inspect " + at("lamp.glb") + " --png " + at("l.png"));
    ASSERT_EQ(light.code, 0) << light.err;
    const std::size_t picture = light.out.find("picture ");
    ASSERT_NE(picture, std::string::npos);
    EXPECT_EQ(light.out.find("rms error", picture), std::string::npos) << light.out;
    EXPECT_EQ(light.out.find("visibility v", picture), std::string::npos) << light.out;
}

TEST_F(Messages, ALightWhoseMeshIsBadIsBad)
{
    folder.write("cut.glb", "glTF\2\0\0\0");
    folder.write("empty.obj", "v 0 0 0\n");
    for (const auto& [source, says] : {std::pair{"cut.glb", "cut in its header"},
                                       {"empty.obj", "no triangles"},
                                       {"none.obj", "No such file"}}) {
        folder.write("glow.json", fmt::format(R"({{"version":1,"type":"mesh","source":"{}",)"
                                              R"("power":[1,1,1]}})",
                                              source));
        const Outcome compiled = run("light " + at("glow.json") + " -o " + at("o.glb"));
        const Outcome checked = run("validate " + at("glow.json"));
        EXPECT_EQ(compiled.code, 1);
        EXPECT_EQ(checked.code, 1);
        for (const char* part : {"glow.json: light.source", says})
            EXPECT_NE(compiled.err.find(part), std::string::npos) << compiled.err;
        EXPECT_EQ(firstLine(compiled.err), firstLine(checked.out));
    }
}

TEST_F(Messages, WhatWasMendedIsCountedWithoutNoughts)
{
    folder.write("sky.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n" +
                                std::string("\x80\x40\x20\xff\x80\x40\x20\x81", 8));
    const Outcome sky = run("environment " + at("sky.hdr") + " -o " + at("sky.env"));
    ASSERT_EQ(sky.code, 0) << sky.err;
    EXPECT_NE(sky.err.find("sky.hdr: "), std::string::npos) << sky.err;
    EXPECT_EQ(sky.err.find("negative"), std::string::npos) << sky.err;
    EXPECT_NE(sky.err.find("absurd pixel"), std::string::npos) << sky.err;
}

TEST_F(Messages, SceneFilesAreBoundedAsInTheRuntime)
{
    const std::string start =
        R"({"version":1,"entities":[{"Transform":{"position":[0,0,0],"rotation":[0,0,0,1],)"
        R"("scale":1},"MeshInstance":{"asset":""}}])";
    folder.write("x.json", start + "}");
    const Outcome unnamed = run("validate " + at("x.json"));
    EXPECT_EQ(unnamed.code, 1);
    EXPECT_NE(unnamed.out.find("entities[0].MeshInstance.asset is empty; name"), std::string::npos)
        << unnamed.out;
    folder.write("x.json", R"({"version":1,"entities":[])" + std::string(64u << 20, ' ') + "}");
    const Outcome large = run("validate " + at("x.json"));
    EXPECT_EQ(large.code, 1);
    EXPECT_NE(large.out.find("a scene has at most 67108864"), std::string::npos) << large.out;
}

TEST_F(Messages, AllThatIsWrongWithALightIsListed)
{
    folder.write("bad.json", R"({"version":2,"type":"disc","radius":-1,"radius":-2,"colour":3,)"
                             R"("power":[1,"2",3],"texture":"none.png"})");
    const Outcome compiled = run("light " + at("bad.json") + " -o " + at("o.glb"));
    const Outcome checked = run("validate " + at("bad.json"));
    EXPECT_EQ(compiled.code, 1);
    for (const char* says :
         {"bad.json: has \"radius\" twice; delete one", "light.version is 2, this program reads 1",
          "light.radius is -2, not a number from",
          "light has the unknown member \"colour\"; known: ",
          "light.power[1] is \"2\", not a number", "light.texture \"none.png\": No such file"}) {
        EXPECT_NE(compiled.err.find(says), std::string::npos) << says << compiled.err;
        EXPECT_NE(checked.out.find(says), std::string::npos) << says << checked.out;
    }
    EXPECT_EQ(linesOf(compiled.err), 6u) << compiled.err;
    EXPECT_EQ(linesOf(checked.out), 7u) << checked.out;
    EXPECT_NE(run("inspect " + at("bad.json")).err.find("; and 5 more: assetc validate"),
              std::string::npos);
    folder.write("none.json", R"({"version":1,"type":7,"power":[0,0,0],"reach":-1})");
    EXPECT_EQ(linesOf(run("light " + at("none.json") + " -o " + at("o.glb")).err), 3u);
}

TEST_F(Messages, AScenesPartsAreLookedInto)
{
    bake("parts", "--per-node");
    std::filesystem::path part;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "parts"))
        if (entry.path().extension() == ".glb")
            part = entry.path();
    const std::string name = part.filename().string(), whole = readText(part);
    const std::string place = ".MeshInstance.asset names \"" + name + "\", which is ";
    std::string spoilt = whole;
    spoilt[spoilt.size() - 100] ^= 1;
    for (const auto& [bytes, says] :
         {std::pair<std::string, std::string>{spoilt, place + "damaged: "},
          {whole.substr(0, 500), place + "no compiled mesh: an unreadable binary glTF file"},
          {"\x89PNG\r\n\x1a\n....", place + "no compiled mesh: a PNG picture"},
          {"", place + "no compiled mesh: an empty file"}}) {
        folder.write("parts/" + name, bytes);
        const Outcome outcome = run("validate " + at("parts/scene.json"));
        EXPECT_EQ(outcome.code, 1);
        EXPECT_NE(outcome.out.find(says), std::string::npos) << outcome.out;
        EXPECT_EQ(linesOf(outcome.out), 2u) << outcome.out; // once, though two components name it
    }
    folder.write("parts/" + name, whole);
    EXPECT_EQ(run("validate " + at("parts/scene.json")).code, 0);
}

TEST_F(Messages, ShapesFarFromTheOriginAreCoarse)
{
    folder.write("far.obj", "v 1000000 0 0\nv 1000001 0 0\nv 1000000 1 0\nf 1 2 3\n");
    const Outcome far = run("bake " + at("far.obj") + " -o " + at("o.glb") + " --no-field");
    EXPECT_EQ(far.code, 0);
    EXPECT_NE(far.err.find("far.obj: lies 1e+06 m from the origin, 1.41e+06 times its radius of "
                           "0.707 m: coordinates there are whole steps of 0.062 m, so its shape "
                           "is coarse; move it to the origin"),
              std::string::npos)
        << far.err;
    folder.write("near.obj", "v 1000 0 0\nv 1001 0 0\nv 1000 1 0\nf 1 2 3\n");
    EXPECT_EQ(run("bake " + at("near.obj") + " -o " + at("o.glb") + " --no-field").err, "");
}

TEST_F(Messages, SkiesAreRadianceAndNotBlack)
{
    const auto sky = [&](const std::string& lines, const std::string& pixels) {
        folder.write("sky.hdr",
                     "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n" + lines + "\n-Y 1 +X 2\n" + pixels);
        return run("environment " + at("sky.hdr") + " -o " + at("sky.env"));
    };
    const auto brightest = [&] {
        const std::string json = run("inspect --json " + at("sky.env")).out;
        return nlohmann::json::parse(json, nullptr, false)["maxLuminance"].get<double>();
    };
    const std::string grey("\x80\x40\x20\x81\x80\x40\x20\x81", 8), black(8, '\0');
    EXPECT_EQ(sky("", grey).err, "");
    const double plain = brightest();
    EXPECT_EQ(sky("EXPOSURE= 2.0\nEXPOSURE=0.25\n", grey).err, ""); // half, in all
    EXPECT_NEAR(brightest(), 2 * plain, 1e-3 * plain);
    for (const char* wrong : {"EXPOSURE=0\n", "EXPOSURE=\n", "EXPOSURE=-1\n", "EXPOSURE=1e9\n"}) {
        const Outcome refused = sky(wrong, grey);
        EXPECT_EQ(refused.code, 1) << wrong;
        EXPECT_NE(refused.err.find("mend or delete the line"), std::string::npos) << refused.err;
    }
    const Outcome dark = sky("", black);
    EXPECT_EQ(dark.code, 0);
    EXPECT_NE(dark.err.find("the map is black and lights nothing"), std::string::npos) << dark.err;
}

TEST_F(Messages, BuffersOfGltfAreMeasured)
{
    auto square = squareGltf();
    const std::string uri = square["buffers"][0]["uri"];
    folder.write("short.bin", "1234");
    for (const auto& [wrong, says] :
         {std::pair<std::string, std::string>{"short.bin",
                                              "buffers[0].uri is wrong: short.bin has 4 "
                                              "bytes, and byteLength is "},
          {uri.substr(0, uri.size() - 8), "buffers[0].uri is wrong: the data has "},
          {"data:text/plain,abc", "buffers[0].uri is data that is not in base64"},
          {"none.bin", "buffers[0].uri cannot be used: \"none.bin\": No such file"},
          {"", "buffers[0] has no \"uri\", and a .gltf"}}) {
        square["buffers"][0]["uri"] = wrong;
        folder.write("b.gltf", square.dump());
        const Outcome outcome = run("bake " + at("b.gltf") + " -o " + at("o.glb"));
        EXPECT_EQ(outcome.code, 1);
        EXPECT_NE(outcome.err.find(says), std::string::npos) << outcome.err;
    }
    square["buffers"][0].erase("uri");
    const auto glb = *writeGlb(square.dump(), {});
    ASSERT_TRUE(writeFile(folder / "b.glb", std::span<const std::byte>(glb)));
    EXPECT_NE(run("validate " + at("b.glb")).out.find("and the file's binary chunk 0; copy"),
              std::string::npos);
}

// The limit of a description holds before its bytes have memory.
TEST_F(Messages, AHugeDescriptionIsNotRead)
{
    folder.write("huge.json", "{");
    std::filesystem::resize_file(folder / "huge.json", 8ull << 30); // a hole
    const Outcome huge = run("light " + at("huge.json") + " -o " + at("o.glb"));
    EXPECT_EQ(huge.code, 1);
    EXPECT_NE(huge.err.find("8589934592 bytes, and a light description has at most 65536"),
              std::string::npos)
        << huge.err;
}

} // namespace penumbra
