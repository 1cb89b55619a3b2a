// The demo's command line: exit codes, one clear message, and what a short run leaves behind. The
// scene's assets are those that the build compiles.
#include "demo/image/image.h"
#include "demo/options.h"
#include "tests/support/program.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <set>

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
    for (const std::string& arguments : {std::string("--size 12"),
                                         std::string("--size 8x8"),
                                         std::string("--frames x"),
                                         std::string("--frames 0"),
                                         "--record " + at("film.avi"),
                                         std::string("--kernel fast"),
                                         std::string("--receivers pixels"),
                                         std::string("--receivers pixel --device cpu-scalar"),
                                         "--receivers pixel --compare-kernels " + at("k.json"),
                                         std::string("--beams 33"),
                                         std::string("--beams 8 --device cpu-scalar"),
                                         "--beams 8 --compare-kernels " + at("k.json"),
                                         std::string("--sweep lights --beams 8"),
                                         std::string("--reference 3"),
                                         std::string("--what"),
                                         std::string("falling"),
                                         "--compare-kernels " + at("k.json") + " --reference",
                                         "--compare-kernels " + at("k.json") + " --out " + at("o"),
                                         "--compare-kernels " + at("k.json") + " --kernel exact",
                                         std::string("--sweep shadows"),
                                         std::string("--sweep"),
                                         std::string("--sweep lights --reference"),
                                         std::string("--sweep lights --scene lights"),
                                         std::string("--sweep lights --kernel exact"),
                                         std::string("--sweep lights --device cpu-scalar"),
                                         "--sweep lights --compare-kernels " + at("k.json")}) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, 2) << arguments << "\n" << outcome.err;
        EXPECT_FALSE(outcome.err.empty()) << arguments;
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "k.json"));
    EXPECT_EQ(run("--help").code, 0);
    EXPECT_NE(run("--list-scenes").out.find("falling"), std::string::npos);
    const std::string help = run("--help").out;
    EXPECT_NE(help.find("--sweep"), std::string::npos);
    // The message names what there is.
    const Outcome unknown = run("--sweep shadows");
    EXPECT_NE(unknown.err.find("lights"), std::string::npos) << unknown.err;
    EXPECT_NE(unknown.err.find("shadows"), std::string::npos) << unknown.err;
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

// A sweep needs no window, and takes the folder of --out.
TEST(DemoOptions, SweepIsHeadless)
{
    std::vector<const char*> words{"penumbra-demo", "--sweep", "lights", "--out", "there"};
    DemoOptions options;
    EXPECT_FALSE(
        parseOptions(static_cast<int>(words.size()), const_cast<char**>(words.data()), options));
    EXPECT_EQ(options.sweep, "lights");
    EXPECT_EQ(options.out, "there");
    EXPECT_TRUE(options.headless);
}

// Pixels are receivers of the benchmark and of the reference alike, and validation has nothing to
// say.
TEST_F(DemoCommandLine, PixelReceiversAreMeasured)
{
    for (const std::string kind : {"pixel", "pixel-half"}) {
        const Outcome outcome = run("--scene coarse --receivers " + kind +
                                    " --frames 1 --size 70x50 --validate --reference 16 --out " +
                                    at(kind) + " --benchmark " + at("b.json"));
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        const auto benchmark = nlohmann::json::parse(readText(folder / "b.json"));
        EXPECT_EQ(benchmark["receivers"], kind);
        for (const char* pass : {"gbuffer", "pixel_clusters", "pixel_bounds", "pixel_resolve"})
            EXPECT_GT(benchmark["gpuMs"][pass], 0) << pass;
        const auto reference = nlohmann::json::parse(readText(folder / kind / "reference.json"));
        EXPECT_EQ(reference["receiverKind"], kind);
        EXPECT_GT(reference["receivers"], 1000);
        EXPECT_LE(reference["receivers"], 70 * 50);
        EXPECT_LT(reference["rmseRelative"], 0.2);
    }
}

// Beams shadow vertices and pixels alike, bring the picture nearer to the truth, and validation has
// nothing to say.
TEST_F(DemoCommandLine, BeamsAreMeasured)
{
    for (const std::string kind : {"vertex", "pixel"}) {
        const auto errorWith = [&](const std::string& beams) {
            const Outcome outcome =
                run("--scene falling --environment studio --receivers " + kind + " --beams " +
                    beams + " --frames 2 --size 70x50 --validate --reference 64 --out " + at(kind) +
                    " --benchmark " + at("b.json"));
            EXPECT_EQ(outcome.code, 0) << outcome.err;
            const auto benchmark = nlohmann::json::parse(readText(folder / "b.json"));
            EXPECT_EQ(benchmark["beams"], std::stoi(beams));
            for (const char* pass : {"beam_maps", "beams"})
                EXPECT_EQ(benchmark["gpuMs"].contains(pass), beams != "0") << pass;
            const auto reference =
                nlohmann::json::parse(readText(folder / kind / "reference.json"));
            EXPECT_EQ(reference["beams"], std::stoi(beams));
            return reference["rmseRelative"].get<double>();
        };
        EXPECT_LT(errorWith("8"), 0.7 * errorWith("0")) << kind;
    }
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
    // Literal has no use for what order 4 of the light leaves out.
    EXPECT_LT(literal["byCause"]["lightBeyondOrder4"], 1e-9);
    EXPECT_GT(exact["byCause"]["lightBeyondOrder4"], 1e-9);
    EXPECT_NEAR(a, b, 1e-4 * b);
    EXPECT_GT(std::abs(a - c), 1e-3 * c);
}

// Every part of the error, and a picture per local light.
TEST_F(DemoCommandLine, ReferenceNamesCausesAndLights)
{
    const Outcome outcome =
        run("--scene lights --frames 1 --size 96x64 --reference 64 --out " + at("lit"));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto json = nlohmann::json::parse(readText(folder / "lit" / "reference.json"));
    double sum = 0;
    for (const char* cause : {"occluderBandLimit", "productTruncation", "fieldSampling",
                              "quantisation", "lightBeyondOrder4", "storedFields"}) {
        ASSERT_TRUE(json["byCause"].contains(cause)) << cause;
        sum += json["byCause"][cause].get<double>();
    }
    // The causes add up receiver by receiver, so their rmse can only sum to more than the whole;
    // the whole is of all receivers, the causes of some.
    EXPECT_GT(sum, 0.7 * json["byCause"]["fieldsAndProducts"].get<double>());
    EXPECT_LT(sum, 4 * json["byCause"]["fieldsAndProducts"].get<double>());
    EXPECT_GT(json["byCause"]["vertexInterpolation"], 0);
    EXPECT_LT(json["byCause"]["vertexInterpolation"], 0.2);

    const auto& lights = json["byLight"]["lights"];
    ASSERT_EQ(lights.size(), 3u);
    EXPECT_EQ(lights[0]["asset"], "ball_lamp");
    EXPECT_EQ(lights[2]["asset"], "picture_lamp");
    EXPECT_EQ(json["byLight"]["byAsset"].size(), 2u);
    double mean = 0;
    for (std::size_t l = 0; l < lights.size(); ++l) {
        for (const char* member :
             {"meanUnshadowed", "rmse", "rmseRelative", "bias", "biasRelative", "maxAbs"})
            EXPECT_TRUE(lights[l][member].is_number()) << l << member;
        for (const char* cause : {"lightBandLimit", "fieldsAndProducts"})
            EXPECT_GT(lights[l]["byCause"][cause], 0) << l;
        mean += lights[l]["meanUnshadowed"].get<double>();
        const Result<Image8> map = readPng(folder / "lit" / fmt::format("error_light_{}.png", l));
        ASSERT_TRUE(map) << map.error().message;
        EXPECT_EQ(map->width, 96u);
        EXPECT_EQ(map->height, 64u);
        EXPECT_GT(std::set(map->rgba.begin(), map->rgba.end()).size(), 10u); // something to see
    }
    // Lights add up.
    EXPECT_NEAR(json["byLight"]["local"]["meanUnshadowed"].get<double>(), mean, 1e-5 * mean);
}

} // namespace penumbra
