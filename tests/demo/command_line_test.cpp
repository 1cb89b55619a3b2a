// The demo's command line: exit codes, one clear message, and what a short run leaves behind. The
// scene's assets are those that the build compiles.
#include "demo/options.h"
#include "tests/support/program.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace penumbra {

namespace {

class DemoCommandLine : public testing::Test {
protected:
    [[nodiscard]] Outcome run(const std::string& arguments) const
    {
        return runProgram(PENUMBRA_DEMO, arguments, folder);
    }
    [[nodiscard]] std::string at(const std::string& name) const
    {
        return fmt::format("'{}'", (folder / name).string());
    }

    TemporaryFolder folder;
};

} // namespace

TEST_F(DemoCommandLine, WrongUsageIsTwo)
{
    for (const std::string& arguments :
         {std::string("--size 12"), std::string("--size 8x8"), std::string("--frames x"),
          std::string("--frames 0"), "--record " + at("film.avi"), std::string("--kernel fast"),
          std::string("--reference 3"), std::string("--what"), std::string("falling"),
          "--compare-kernels " + at("k.json") + " --reference",
          "--compare-kernels " + at("k.json") + " --out " + at("o"),
          "--compare-kernels " + at("k.json") + " --kernel exact"}) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, 2) << arguments << "\n" << outcome.err;
        EXPECT_FALSE(outcome.err.empty()) << arguments;
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "k.json"));
    EXPECT_EQ(run("--help").code, 0);
    EXPECT_NE(run("--list-scenes").out.find("falling"), std::string::npos);
}

TEST_F(DemoCommandLine, BadInputIsOne)
{
    for (const std::string& arguments :
         {std::string("--headless --scene nowhere"), std::string("--headless --environment mars"),
          "--headless --assets " + at("empty"), std::string("--headless --device 99")}) {
        const Outcome outcome = run(arguments + " --frames 1 --size 64x64");
        EXPECT_EQ(outcome.code, 1) << arguments;
        const auto lines = std::count(outcome.err.begin(), outcome.err.end(), '\n');
        if (arguments.ends_with("99"))
            EXPECT_GE(lines, 2) << outcome.err; // the devices there are follow
        else
            EXPECT_EQ(lines, 1) << outcome.err;
    }
}

// `--reference` takes its default where no number follows, also as the last word.
TEST(DemoOptions, ReferenceNeedsNoNumber)
{
    const auto samplesOf = [](std::vector<const char*> words) {
        words.insert(words.begin(), "penumbra-demo");
        DemoOptions options;
        EXPECT_FALSE(parseOptions(static_cast<int>(words.size()), const_cast<char**>(words.data()),
                                  options));
        return options.reference.value_or(0);
    };
    EXPECT_EQ(samplesOf({"--reference"}), 1024u);
    EXPECT_EQ(samplesOf({"--reference", "--seed", "2"}), 1024u);
    EXPECT_EQ(samplesOf({"--reference", "256"}), 256u);
    EXPECT_EQ(samplesOf({}), 0u);
}

// The scalar path is compared as it is, not redrawn by the device.
TEST_F(DemoCommandLine, ReferenceOfTheScalarPathIsKernelLiteral)
{
    const auto errorOf = [&](const std::string& how) {
        const Outcome outcome =
            run("--frames 1 --size 64x64 --reference 64 --out " + at(how) + " " + how);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return nlohmann::json::parse(readText(folder / how / "reference.json"));
    };
    const auto scalar = errorOf("--device=cpu-scalar");
    const auto literal = errorOf("--kernel=literal");
    const auto exact = errorOf("--kernel=exact");
    EXPECT_EQ(scalar["kernel"], "cpu-scalar");
    const double a = scalar["rmse"], b = literal["rmse"], c = exact["rmse"];
    EXPECT_NEAR(a, b, 1e-4 * b);
    EXPECT_GT(std::abs(a - c), 1e-3 * c);
}

} // namespace penumbra
