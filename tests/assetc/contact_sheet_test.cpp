// assetc inspect --png: a picture per asset, and what it refuses.
#include "tests/assetc/gltf_fixture.h"
#include "tests/support/program.h"

#include <gtest/gtest.h>

namespace penumbra {

namespace {

class ContactSheet : public testing::Test {
protected:
    Outcome run(const std::string& arguments) const
    {
        return runProgram(PENUMBRA_ASSETC, arguments, folder);
    }
    [[nodiscard]] std::string at(const std::string& name) const
    {
        return fmt::format("'{}'", (folder / name).string());
    }
    void bake(const std::string& name, const std::string& options)
    {
        folder.write("square.gltf", squareGltf().dump());
        const Outcome outcome =
            run("bake " + at("square.gltf") + " -o " + at(name) +
                " --shells 8 --max-side 5 --directions 64 --threshold 0 " + options);
        ASSERT_EQ(outcome.code, 0) << outcome.err;
    }

    TemporaryFolder folder;
};

struct Size {
    std::uint32_t width = 0, height = 0;
};

// Of a PNG by its signature and its first chunk, IHDR; 0 where the bytes are something else.
Size pngSize(const std::string& bytes)
{
    if (bytes.size() < 24 || bytes.substr(0, 8) != "\x89PNG\r\n\x1a\n")
        return {};
    const auto number = [&](std::size_t first) {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < 4; ++i)
            value = value << 8 | static_cast<unsigned char>(bytes[first + i]);
        return value;
    };
    return {number(16), number(20)};
}

} // namespace

TEST_F(ContactSheet, ShowsMoreOfAnAssetWithAField)
{
    bake("full.glb", "");
    bake("bare.glb", "--no-field");
    const Outcome full = run("inspect " + at("full.glb") + " --png " + at("full.png"));
    ASSERT_EQ(full.code, 0) << full.err;
    EXPECT_NE(full.out.find("picture"), std::string::npos) << full.out;
    const Outcome bare = run("inspect --json " + at("bare.glb") + " --png " + at("bare.png"));
    ASSERT_EQ(bare.code, 0) << bare.err;
    EXPECT_TRUE(nlohmann::json::accept(bare.out)) << bare.out;

    const std::string first = readText(folder / "full.png");
    const Size fullSize = pngSize(first), bareSize = pngSize(readText(folder / "bare.png"));
    EXPECT_EQ(fullSize.width, 1296);
    EXPECT_EQ(bareSize.width, 1296);
    EXPECT_GT(bareSize.height, 400);
    EXPECT_GT(fullSize.height, bareSize.height + 300);

    ASSERT_EQ(run("inspect " + at("full.glb") + " --png " + at("full.png")).code, 0);
    EXPECT_EQ(readText(folder / "full.png"), first); // the same picture again
}

TEST_F(ContactSheet, DrawsALight)
{
    folder.write("lamp.json",
                 R"({"version": 1, "type": "sphere", "radius": 0.1, "power": [4, 3, 2]})");
    const Outcome light = run("light " + at("lamp.json") + " -o " + at("lamp.glb") +
                              " --shells 2 --max-side 5 --directions 64");
    ASSERT_EQ(light.code, 0) << light.err;
    const Outcome sheet = run("inspect " + at("lamp.glb") + " --png " + at("lamp.png"));
    ASSERT_EQ(sheet.code, 0) << sheet.err;
    EXPECT_GT(pngSize(readText(folder / "lamp.png")).height, 700);
}

TEST_F(ContactSheet, RefusesWithOneMessage)
{
    bake("full.glb", "");
    const std::string inspect = "inspect " + at("full.glb");
    EXPECT_EQ(run(inspect + " --png " + at("sheet.jpg")).code, 2);
    EXPECT_FALSE(std::filesystem::exists(folder / "sheet.jpg"));

    folder.write("file", "x");
    const Outcome unwritable = run(inspect + " --png " + at("file/sheet.png"));
    EXPECT_EQ(unwritable.code, 1);
    EXPECT_NE(unwritable.err.find("/file"), std::string::npos) << unwritable.err;

    const Outcome source = run("inspect " + at("square.gltf") + " --png " + at("sheet.png"));
    EXPECT_EQ(source.code, 1);
    EXPECT_NE(source.err.find("compile it first"), std::string::npos) << source.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "sheet.png"));
    EXPECT_EQ(run("validate " + at("full.glb") + " --png " + at("sheet.png")).code, 2);
}

} // namespace penumbra
