// --sweep lights: the competitor's scene, a small sweep on the device, and what is written of one.
#include "demo/sweep/sweep_report.h"
#include "demo/sweep/sweep_scene.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/program.h"

#include <algorithm>
#include <sstream>

namespace penumbra {
namespace {

const std::filesystem::path kAssets =
    std::filesystem::path(PENUMBRA_DEMO).parent_path().parent_path() / "assets";

SweepRow row(const std::string& light, float angle, const std::string& method, double error,
             double nanoseconds)
{
    RadianceErrors errors;
    errors.meanUnshadowed = 2;
    errors.rmse = 2 * error;
    errors.rmseRelative = error;
    errors.bias = -0.5;
    errors.maxAbs = 1;
    return {light, angle, method, 100, errors, nanoseconds};
}

// Rays whose error falls with their root, at 10 ns each and 100 to start.
std::vector<SweepRow> madeUpRows(double exact)
{
    std::vector<SweepRow> rows;
    for (const float angle : {10.0f, 90.0f}) {
        rows.push_back(row("cap", angle, "exact", exact, 500));
        for (const int rays : {16, 64, 256})
            rows.push_back(row("cap", angle, fmt::format("rays{}", rays), 0.4 / std::sqrt(rays),
                               100 + 10 * rays));
        rows.push_back(row("cap", angle, "truth", 0.001, 0));
    }
    return rows;
}

TEST(SweepReport, CsvHasItsColumns)
{
    const std::vector<SweepRow> rows = madeUpRows(0.05);
    std::istringstream csv(sweepCsv(rows));
    std::string line;
    std::getline(csv, line);
    EXPECT_EQ(line, "light,halfAngleDegrees,method,receivers,meanUnshadowed,rmseRelative,"
                    "biasRelative,maxRelative,nsPerReceiver");
    std::getline(csv, line);
    EXPECT_EQ(line, "cap,10,exact,100,2,0.05,-0.25,0.5,500");
    std::size_t count = 1;
    std::string last;
    while (std::getline(csv, line)) {
        EXPECT_EQ(std::count(line.begin(), line.end(), ','), 8);
        last = line;
        ++count;
    }
    EXPECT_EQ(count, rows.size());
    EXPECT_TRUE(last.ends_with(",")) << last; // the truth is not timed
}

TEST(SweepReport, RaysOfEqualErrorLieOnTheirLine)
{
    for (const double rays : {4.0, 32.0, 64.0, 100.0, 1024.0}) {
        const EqualRays equal = raysOfEqualError(madeUpRows(0.4 / std::sqrt(rays)), "cap", 90);
        EXPECT_NEAR(equal.rays, rays, 1e-6 * rays);
        // Below the least count, in proportion to it.
        const double wanted = rays < 16 ? 260 * rays / 16 : 100 + 10 * rays;
        EXPECT_NEAR(equal.nanoseconds, wanted, 1e-6 * rays);
    }
    EXPECT_EQ(raysOfEqualError(madeUpRows(9), "cap", 90).rays, 1); // one ray is better
    EXPECT_EQ(raysOfEqualError(madeUpRows(1), "sphere", 90).rays, 0);
}

TEST(SweepReport, WritesTableAndPicture)
{
    const TemporaryFolder folder;
    const std::vector<SweepRow> rows = madeUpRows(0.05);
    ASSERT_TRUE(writeSweep(rows, folder / "out"));
    EXPECT_EQ(readText(folder / "out" / "sweep_lights.csv"), sweepCsv(rows));
    const Result<Image8> picture = readPng(folder / "out" / "sweep_lights.png");
    ASSERT_TRUE(picture);
    EXPECT_GT(picture->width, 1000u);
    EXPECT_NE(sweepTable(rows).find("rays256"), std::string::npos);
}

// Both lights give the floor the same, and the map says what the disc says.
TEST(SweepScene, LightsAreEven)
{
    for (const float angle : {5.0f, 20.0f, 40.0f}) {
        for (const RoundLight& light : {sweepCap(angle), sweepSphere(angle)}) {
            const RoundView view = light.seenFrom(vec3(0));
            EXPECT_NEAR(std::asin(view.sine) * 180 / 3.14159265, angle, 1e-3);
            EXPECT_NEAR(light.radiance() * roundIrradiance(view, vec3(0, 1, 0)), 3.14159265, 1e-4);
        }
        const Environment map = capEnvironment(angle);
        const Sh4Light sh4 = sh4Of(sweepCap(angle), vec3(0));
        for (std::size_t k = 0; k < 16; ++k)
            EXPECT_NEAR(map.sh4[k].x, sh4.radiance[k].x, 0.01f * sh4.radiance[0].x) << k;
    }
    // What lies below the ground gives no light.
    EXPECT_LT(capEnvironment(90).sh4[0].x, 0.9f * sh4Of(sweepCap(90), vec3(0)).radiance[0].x);
}

class SweepTest : public GpuTest {};

// The laws that any such sweep obeys, on one object with few rays.
TEST_F(SweepTest, SmallSweep)
{
    SweepLightsOptions options;
    options.assets = kAssets;
    options.halfAngles = {10, 40, 80};
    options.rays = {4, 16, 64};
    options.truthRays = 2048;
    options.receivers = 768;
    options.objects = 1;
    options.repeats = 1;
    const std::vector<SweepRow> rows = take(sweepLights(device(), options));
    const auto at = [&](const std::string& light, float angle, const std::string& method) {
        const auto found = std::find_if(rows.begin(), rows.end(), [&](const SweepRow& r) {
            return r.light == light && r.halfAngle == angle && r.method == method;
        });
        EXPECT_NE(found, rows.end()) << light << ' ' << angle << ' ' << method;
        return found->errors.rmseRelative;
    };
    EXPECT_EQ(rows.size(), (3 + 2) * 7u); // no sphere of 80 degrees stands above the floor
    for (const std::string light : {"cap", "sphere"})
        for (const float angle : {10.0f, 40.0f}) {
            // Rays: at least as the root of their number, but for luck.
            EXPECT_LT(at(light, angle, "rays16"), 0.6 * at(light, angle, "rays4"));
            EXPECT_LT(at(light, angle, "rays64"), 0.6 * at(light, angle, "rays16"));
            EXPECT_LT(at(light, angle, "truth"), 0.3 * at(light, angle, "rays64"));
        }
    for (const std::string method : {"exact", "literal", "order4"}) {
        EXPECT_LT(at("cap", 40, method), at("cap", 10, method)) << method;
        EXPECT_LT(at("cap", 80, method), at("cap", 40, method)) << method;
        EXPECT_LT(at("sphere", 40, method), at("sphere", 10, method)) << method;
    }
    // No far-off light or wrong place: the fields are near the bound of their order.
    EXPECT_LT(at("cap", 80, "exact"), 0.05);
    EXPECT_LT(at("cap", 10, "exact"), 1.5 * at("cap", 10, "order4"));
    for (const SweepRow& r : rows)
        EXPECT_EQ(r.nanoseconds > 0, r.method != "truth" && r.method != "order4") << r.method;
}

TEST_F(SweepTest, MissingAssetsAreAnError)
{
    SweepLightsOptions options;
    options.assets = "/nowhere";
    const auto rows = sweepLights(device(), options);
    ASSERT_FALSE(rows);
    EXPECT_NE(rows.error().message.find("floor.glb"), std::string::npos) << rows.error().message;
}

} // namespace
} // namespace penumbra
