// `assetc build` that is killed, interrupted, watched, or not alone.
#include "tests/assetc/build_fixture.h"

#include <algorithm>

namespace penumbra {

namespace {

class BuildProcess : public BuildTest {
protected:
    // Assets that take long enough, some 0.1 s each, to be hit.
    void writeSlow(int count)
    {
        manifest["defaults"]["mesh"] = {{"shells", 6}, {"maxSide", 17}, {"directions", 1024}};
        writePyramids(count);
    }
    [[nodiscard]] std::unique_ptr<BackgroundProgram> start(const std::string& more = "") const
    {
        std::vector<std::string> all = arguments("built");
        if (!more.empty())
            all.push_back(more);
        return std::make_unique<BackgroundProgram>(PENUMBRA_ASSETC, all, folder / "log");
    }
    [[nodiscard]] bool exists(const std::string& name) const
    {
        return std::filesystem::exists(folder / name);
    }
    [[nodiscard]] std::string log() const { return readText(folder / "log"); }

    // What is there of the outputs is whole.
    void expectWhole(const std::map<std::string, std::string>& good) const
    {
        for (const auto& [name, bytes] : files()) {
            ASSERT_TRUE(good.contains(name)) << name;
            EXPECT_EQ(bytes, good.at(name)) << name;
        }
    }
};

} // namespace

TEST_F(BuildProcess, KilledBuildsResume)
{
    writeSlow(10);
    build(0, "", "good");
    const auto good = files("good");
    for (int kill = 0; kill < 8; kill += 3) {
        const auto running = start();
        ASSERT_TRUE(waitUntil([&] { return exists(fmt::format("built/m{}.glb", kill)); })) << log();
        running->signal(SIGKILL);
        EXPECT_EQ(running->wait(), -SIGKILL);
        expectWhole(good);
    }
    folder.write("built/.penumbra/temporary/m7.glb.AbCdEf", "half a fi");
    const auto report = build();
    EXPECT_GE(named(report, "unchanged").size(), 5u); // m6 was seen, its record perhaps not
    EXPECT_EQ(files(), good);
    EXPECT_EQ(temporaries(), 0u);
}

TEST_F(BuildProcess, InterruptEndsSoonAndLeavesNothing)
{
    writeSlow(10);
    build(0, "", "good");
    for (const auto& [signal, code] : {std::pair{SIGINT, 130}, std::pair{SIGTERM, 143}}) {
        const auto running = start();
        const std::string next = signal == SIGINT ? "built/m1.glb" : "built/m4.glb";
        ASSERT_TRUE(waitUntil([&] { return exists(next); })) << log();
        running->signal(signal);
        EXPECT_EQ(running->wait(), code);
        EXPECT_EQ(temporaries(), 0u);
        expectWhole(files("good"));
    }
    build();
    EXPECT_EQ(files(), files("good"));
}

TEST_F(BuildProcess, TwoAtOnceShareTheWork)
{
    writeSlow(6);
    build(0, "", "good");
    std::vector<std::string> second = arguments("built");
    second.back() = at("second.json");
    const auto a = start();
    BackgroundProgram b(PENUMBRA_ASSETC, second, folder / "log2");
    EXPECT_EQ(a->wait(), 0) << log();
    EXPECT_EQ(b.wait(), 0) << readText(folder / "log2");
    EXPECT_EQ(files(), files("good"));
    const auto built = [&](const char* report) {
        return nlohmann::json::parse(readText(folder / report))["totals"]["built"].get<int>();
    };
    EXPECT_EQ(built("built.json") + built("second.json"), 6); // each asset once
    EXPECT_EQ(named(build(), "built"), Names());
}

// Each writes the other's outputs over; whatever wins, the next build knows what is there.
TEST_F(BuildProcess, TwoManifestsIntoOneFolder)
{
    writePyramids(6);
    std::vector<std::string> other = arguments("built");
    other[1] = at("other.json");
    other.back() = at("second.json");
    auto changed = manifest;
    changed["defaults"]["mesh"]["shells"] = 5;
    folder.write("other.json", changed.dump());
    build(0, "", "good");
    for (int round = 0; round < 5; ++round) {
        const auto a = start();
        BackgroundProgram b(PENUMBRA_ASSETC, other, folder / "log2");
        EXPECT_EQ(a->wait(), 0) << log();
        EXPECT_EQ(b.wait(), 0) << readText(folder / "log2");
        build();
        EXPECT_EQ(files(), files("good"));
    }
}

TEST_F(BuildProcess, WatchBuildsAtEachChange)
{
    writePyramids(2);
    const auto watching = start("--watch");
    const auto lines = [&] {
        const std::string text = log();
        return std::count(text.begin(), text.end(), '\n');
    };
    ASSERT_TRUE(waitUntil([&] { return lines() == 1; })) << log();
    folder.write("m1.obj", pyramid(7));
    ASSERT_TRUE(waitUntil([&] { return lines() == 2; })) << log();
    EXPECT_NE(log().find("1 built, 1 unchanged"), std::string::npos) << log();
    folder.write("m1.obj", "v 1 x\n");
    ASSERT_TRUE(waitUntil([&] { return lines() == 4; })) << log(); // the error and the summary
    EXPECT_NE(log().find("m1.obj: line 1"), std::string::npos) << log();
    folder.write("m1.obj", pyramid(3));
    ASSERT_TRUE(waitUntil([&] { return lines() == 5; })) << log();
    folder.write("manifest.json", "{");
    ASSERT_TRUE(waitUntil([&] { return lines() == 6; })) << log();
    manifest["assets"].erase(1);
    writeManifest();
    ASSERT_TRUE(waitUntil([&] { return lines() == 8; })) << log(); // m1.glb is stale
    EXPECT_NE(log().find(": 1 asset, 0 built, 1 unchanged"), std::string::npos) << log();
    watching->signal(SIGINT);
    EXPECT_EQ(watching->wait(), 0);
}

} // namespace penumbra
