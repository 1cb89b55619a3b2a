// Light descriptions from outside: each wrong one is refused with its place, and the command keeps
// the contract of the others.
#include "tests/support/program.h"

#include "assetc/light/picture.h"
#include "assetc/light/spec.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace penumbra {

namespace {

class LightSpecFile : public testing::Test {
protected:
    Result<LightSpec> read(const std::string& text)
    {
        JsonProblems problems;
        auto spec = readLightSpec(folder.write("in/light.json", text), problems);
        return spec ? Result<LightSpec>(std::move(*spec)) : joined(problems);
    }

    TemporaryFolder folder;
};

const std::string kSphere = R"("version":1,"type":"sphere","radius":1)";

} // namespace

TEST_F(LightSpecFile, ReadsEveryMember)
{
    folder.write("in/a.png", "x");
    const auto spec = read(R"({"version":1,"type":"disc","radius":0.5,"power":[1,2,3],
                               "twoSided":true,"reach":40,"texture":"a.png"})");
    ASSERT_TRUE(spec) << spec.error().message;
    EXPECT_EQ(spec->shape, EmitterShape::Disc);
    EXPECT_EQ(spec->unit, EmissionUnit::Power);
    EXPECT_EQ(spec->emission, vec3(1, 2, 3));
    EXPECT_EQ(spec->radius, 0.5f);
    EXPECT_EQ(spec->reach, 40);
    EXPECT_TRUE(spec->twoSided);
    EXPECT_EQ(spec->texture.filename(), "a.png");
}

TEST_F(LightSpecFile, WrongOnesAreRefusedWithTheirPlace)
{
    folder.write("outside.png", "x");
    const std::string spot = R"({"version":1,"type":"spot","radius":1,"intensity":[1,1,1],)";
    const std::string rectangle = R"({"version":1,"type":"rectangle","radiance":[1,1,1],)";
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"", "an empty file"},
        {"[]", "root"},
        {"{}", "version"},
        {R"({"version":2,"type":"sphere","radius":1,"radiance":[1,1,1]})", "version"},
        {R"({"version":"1","type":"sphere","radius":1,"radiance":[1,1,1]})", "version"},
        {R"({"version":1,"radius":1,"radiance":[1,1,1]})", "type"},
        {R"({"version":1,"type":"cone","radius":1,"radiance":[1,1,1]})",
         "is \"cone\", not one of sphere"},
        {R"({"version":1,"type":7,"radius":1,"radiance":[1,1,1]})", "type is 7, not text"},
        {"{" + kSphere + "}", "radiance"},
        {"{" + kSphere + R"(,"radiance":[1,1,1],"power":[1,1,1]})", "exactly one"},
        {"{" + kSphere + R"(,"radiance":[1,1]})", "radiance"},
        {"{" + kSphere + R"(,"radiance":[1,1,1,1]})", "radiance"},
        {"{" + kSphere + R"(,"radiance":1})", "radiance"},
        {"{" + kSphere + R"(,"radiance":[1,-1,1]})", "radiance[1] is -1, not a number"},
        {"{" + kSphere + R"(,"radiance":[1,"1",1]})", "radiance[1] is \"1\", not a number"},
        {"{" + kSphere + R"(,"radiance":[1,1,null]})", "radiance[2]"},
        {"{" + kSphere + R"(,"radiance":[1,1e8,1]})", "radiance[1]"},
        {"{" + kSphere + R"(,"radiance":[1,1e999,1]})", "JSON"},
        {"{" + kSphere + R"(,"radiance":[1,NaN,1]})", "JSON"},
        {"{" + kSphere + R"(,"radiance":[0,0,0]})", "black"},
        {"{" + kSphere + R"(,"intensity":[1,1,1]})", "intensity"},
        {"{" + kSphere + R"(,"radiance":[1,1,1],"colour":3})", "colour"},
        {"{" + kSphere + R"(,"radiance":[1,1,1],"texture":"a.png"})", "texture"},
        {"{" + kSphere + R"(,"radiance":[1,1,1],"reach":-1})", "reach"},
        {R"({"version":1,"type":"sphere","radius":-1,"radiance":[1,1,1]})", "radius"},
        {R"({"version":1,"type":"sphere","radius":0,"radiance":[1,1,1]})", "radius"},
        {R"({"version":1,"type":"sphere","radius":[1],"radiance":[1,1,1]})", "radius"},
        {rectangle + R"("size":[1]})", "size is an array of 1, not two lengths"},
        {rectangle + R"("size":[1,2,3]})", "size"},
        {rectangle + R"("size":[1,0]})", "size[1]"},
        {rectangle + R"("size":[1000,0.001]})", "is 1000 by 0.001, more than 1000 times"},
        {rectangle + R"("size":[1,1],"twoSided":1})", "twoSided"},
        {rectangle + R"("size":[1,1],"texture":7})", "texture"},
        {rectangle + R"("size":[1,1],"texture":"missing.png"})", "missing.png"},
        {rectangle + R"("size":[1,1],"texture":"../outside.png"})", "plain path"},
        {rectangle + R"("size":[1,1],"texture":"/etc/passwd"})", "plain path"},
        {spot + R"("innerAngle":10,"outerAngle":90})", "outerAngle"},
        {spot + R"("innerAngle":30,"outerAngle":20})", "innerAngle is 30, not 0.1 degrees below"},
        {spot + R"("innerAngle":-1,"outerAngle":20})", "innerAngle"},
        {spot + R"("outerAngle":20})", "innerAngle"},
        {R"({"version":1,"type":"mesh","radiance":[1,1,1]})", "source"},
        {R"({"version":1,"type":"mesh","source":"../a.obj","radiance":[1,1,1]})", "plain path"},
        {std::string("{").append(100000, ' ') + "}",
         "100002 bytes, and a light description has at most"},
        {"v 0 0 0\n" + std::string(100000, ' '), "a Wavefront OBJ mesh; compile it with"},
    };
    for (const auto& [text, place] : cases) {
        const auto spec = read(text);
        ASSERT_FALSE(spec) << text;
        EXPECT_NE(spec.error().message.find("light.json"), std::string::npos)
            << spec.error().message;
        EXPECT_NE(spec.error().message.find(place), std::string::npos) << text << "\n"
                                                                       << spec.error().message;
    }
}

TEST_F(LightSpecFile, HugeAndDamagedPicturesGetNoMemory)
{
    const auto bigEndian = [](std::uint32_t v) {
        return std::string{char(v >> 24), char(v >> 16), char(v >> 8), char(v)};
    };
    const auto png = [&](std::uint32_t width, std::uint32_t height) {
        return std::string("\x89PNG\r\n\x1a\n") + bigEndian(13) + "IHDR" + bigEndian(width) +
               bigEndian(height) + std::string("\x08\x02\0\0\0crc!", 9) + bigEndian(0) + "IEND";
    };
    const std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y ";
    for (const std::string& bytes :
         {std::string(), std::string("GIF89a"), png(0x7fffffff, 0x7fffffff), png(5000, 1),
          png(4096, 4096), png(0, 0), png(4, 4), hdr + "5000 +X 1\n", hdr + "4096 +X 4096\n",
          hdr + "4 +X 4\n", std::string("\xff\xd8\xff\xe0"), std::string("\x76\x2f\x31\x01junk")}) {
        const auto picture = readLightPicture(folder.write("p", bytes));
        EXPECT_FALSE(picture);
    }
    const auto good =
        readLightPicture(folder.write("p", hdr + "1 +X 1\n" + std::string("\x80\x40\x00\x81", 4)));
    ASSERT_TRUE(good) << good.error().message;
    EXPECT_EQ(good->pixels.front(), vec3(1, 0.5f, 0));
}

TEST_F(LightSpecFile, CommandKeepsTheContract)
{
    const auto run = [&](const std::string& arguments) {
        return runProgram(PENUMBRA_ASSETC, arguments, folder);
    };
    const auto at = [&](const std::string& name) {
        return fmt::format("'{}'", (folder / name).string());
    };
    folder.write("lamp.json", "{" + kSphere + R"(,"power":[10,10,10]})");
    const std::string quick = " --shells 4 --max-side 9 --jobs 2 ";
    const Outcome good = run("light " + at("lamp.json") + " -o " + at("lamp.glb") + quick +
                             "--report " + at("report.json"));
    ASSERT_EQ(good.code, 0) << good.err;
    const auto report = nlohmann::json::parse(readText(folder / "report.json"));
    EXPECT_EQ(report["light"]["type"], "sphere");
    EXPECT_NEAR(report["light"]["power"][1].get<double>(), 10, 1e-4);
    EXPECT_EQ(report["field"]["kind"], "radiance");
    EXPECT_EQ(run("validate " + at("lamp.glb")).code, 0);
    const auto inspected = nlohmann::json::parse(run("inspect --json " + at("lamp.glb")).out);
    EXPECT_EQ(inspected["field"]["kind"], "radiance");
    EXPECT_EQ(inspected["field"]["channels"], 3);
    EXPECT_NE(run("inspect " + at("lamp.glb")).out.find("light     3 channels"), std::string::npos);
    EXPECT_EQ(run("light --help").code, 0);

    for (const char* wrong :
         {"--shells 1", "--max-side 10", "--threshold 2", "--jobs 0", "--directions 3", "extra"})
        EXPECT_EQ(run("light " + at("lamp.json") + " -o " + at("o.glb") + " " + wrong).code, 2)
            << wrong;
    EXPECT_EQ(run("light " + at("lamp.json") + " -o " + at("o.gltf")).code, 2);

    folder.write("black.hdr", std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n") +
                                  std::string(4, '\0'));
    const std::string disc = R"({"version":1,"type":"disc","radius":1,)";
    folder.write("bad0.json", disc + R"("radiance":[1,1,1],"texture":"black.hdr"})");
    folder.write("bad1.json", disc + R"("power":[1,1,1],"texture":"black.hdr"})");
    folder.write("bad2.json", disc + R"("radiance":[1,1,1],"reach":1e6})");
    folder.write("bad3.json", disc + R"("power":[1e12,1,1]})");
    folder.write("bad4.json", disc + R"("radiance":[1,1,1],"texture":"bad0.json"})");
    folder.write("bad5.json",
                 R"({"version":1,"type":"mesh","source":"bad0.json","power":[1,1,1]})");
    folder.write("bad6.json", "nonsense");
    for (const std::string name :
         {"bad0", "bad1", "bad2", "bad3", "bad4", "bad5", "bad6", "none"}) {
        const Outcome bad = run("light " + at(name + ".json") + " -o " + at("o.glb") + quick);
        EXPECT_EQ(bad.code, 1) << name << bad.err;
        EXPECT_EQ(std::count(bad.err.begin(), bad.err.end(), '\n'), 1) << bad.err;
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "o.glb"));
}

} // namespace penumbra
