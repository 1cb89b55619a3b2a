// Environment maps from files: synthetic ones with known content, damaged ones, and published ones
// where present.
#include "assetc/environment.h"

#include "shaders/shared/environment.h"
#include "tests/assets/environment/exr_fixture.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <gtest/gtest.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <sstream>

namespace penumbra {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

std::string hdrHeader(int width, int height)
{
    return fmt::format("#?RADIANCE\n# made by a test\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n",
                       height, width);
}

EnvironmentSource uniformSource(std::uint32_t width, std::uint32_t height, vec3 value)
{
    return {width, height, std::vector<vec3>(std::size_t{width} * height, value)};
}

TEST(OpenExr, ReadsScanlinesTilesAndOffsetWindows)
{
    for (const bool tiled : {false, true}) {
        const Result<EnvironmentSource> source =
            decodeOpenExr(makeExr("RGBA", Imf::ZIP_COMPRESSION, tiled));
        ASSERT_TRUE(source) << source.error().message;
        ASSERT_EQ(source->width, 8u);
        ASSERT_EQ(source->height, 4u);
        EXPECT_EQ(source->pixels[0], vec3(0, 100, 200));
        EXPECT_EQ(source->pixels[8 * 2 + 5], vec3(25, 125, 225));
    }
}

TEST(OpenExr, LuminanceAloneIsGrey)
{
    const Result<EnvironmentSource> source =
        decodeOpenExr(makeExr("Y", Imf::PIZ_COMPRESSION, false));
    ASSERT_TRUE(source) << source.error().message;
    EXPECT_EQ(source->pixels[9], vec3(11));
    EXPECT_FALSE(decodeOpenExr(makeExr("RG", Imf::NO_COMPRESSION, false)));
}

// The library would take 2 GB for an attribute that says it is so long.
TEST(OpenExr, AttributesMustLieInTheFile)
{
    std::vector<std::byte> bytes = makeExr("RGB", Imf::NO_COMPRESSION, false);
    const std::string name("channels\0chlist\0", 16);
    const auto at = std::search(bytes.begin(), bytes.end(), name.begin(), name.end(),
                                [](std::byte b, char c) { return b == std::byte(c); });
    ASSERT_NE(at, bytes.end());
    at[14] = std::byte{'x'}; // a type that the library does not know and keeps as it is
    at[16 + 3] = std::byte{0x7f};
    const auto source = decodeOpenExr(bytes);
    ASSERT_FALSE(source);
    EXPECT_NE(source.error().message.find("cut in its header"), std::string::npos)
        << source.error().message;
}

// 512 channels of a picture 16384 wide: 8 GiB for one block of 256 lines.
TEST(OpenExr, ChannelsAreBounded)
{
    const Imath::Box2i window({0, 0}, {16383, 0});
    Imf::Header header(window, window);
    for (int i = 0; i < 512; ++i)
        header.channels().insert(fmt::format("{}", i), Imf::Channel(Imf::FLOAT));
    header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
    StringStream stream;
    {
        Imf::OutputFile file(stream, header);
    }
    const auto source = decodeOpenExr(toBytes(stream.str()));
    ASSERT_FALSE(source);
    EXPECT_NE(source.error().message.find("above the limit"), std::string::npos)
        << source.error().message;
}

TEST(OpenExr, DamageIsAnErrorOrAPicture)
{
    for (const Imf::Compression compression : {Imf::ZIP_COMPRESSION, Imf::DWAB_COMPRESSION}) {
        const std::vector<std::byte> good = makeExr("RGB", compression, false);
        for (std::size_t size = 0; size < good.size(); ++size)
            EXPECT_FALSE(decodeOpenExr(std::span(good).first(size))) << size;
        std::mt19937 random(5);
        for (int round = 0; round < 500; ++round) {
            std::vector<std::byte> bytes = good;
            bytes[random() % bytes.size()] = static_cast<std::byte>(random());
            const Result<EnvironmentSource> source = decodeOpenExr(bytes);
            if (source) {
                ASSERT_EQ(source->pixels.size(), std::size_t{source->width} * source->height);
            }
        }
    }
}

TEST(RadianceHdr, ReadsRunsAndPlainPixels)
{
    // Row 0: a run of eight 128s in r, literal 1 … 8 in g, runs in b and e (2^0 = 1 / 256 of
    // mantissa 256).
    std::string runs =
        hdrHeader(8, 1) + std::string("\2\2\0\x8", 4) + "\x88\x80" + "\x8\1\2\3\4\5\6\7\x8";
    runs += std::string("\x88\0", 2) + "\x88\x81";
    const Result<EnvironmentSource> a = decodeRadianceHdr(toBytes(runs));
    ASSERT_TRUE(a) << a.error().message;
    EXPECT_EQ(a->pixels[0], vec3(1.0f, 1.0f / 128, 0));
    EXPECT_EQ(a->pixels[7], vec3(1.0f, 8.0f / 128, 0));

    const Result<EnvironmentSource> b = decodeRadianceHdr(
        toBytes(hdrHeader(2, 1) + "\x80\x40\x20\x82" + std::string("\x1\x1\x1\0", 4)));
    ASSERT_TRUE(b) << b.error().message;
    EXPECT_EQ(b->pixels[0], vec3(2.0f, 1.0f, 0.5f));
    EXPECT_EQ(b->pixels[1], vec3(0));
}

TEST(RadianceHdr, DamageIsAnError)
{
    std::string good = hdrHeader(8, 2);
    for (int row = 0; row < 2; ++row)
        good += std::string("\2\2\0\x8", 4) + "\x88\x80\x88\x81\x88\x82\x88\x83";
    ASSERT_TRUE(decodeRadianceHdr(toBytes(good)));
    for (std::size_t size = 0; size < good.size(); ++size)
        EXPECT_FALSE(decodeRadianceHdr(toBytes(good.substr(0, size)))) << size;
    EXPECT_FALSE(decodeRadianceHdr(toBytes(hdrHeader(1 << 20, 1 << 20))));
    EXPECT_FALSE(decodeRadianceHdr(toBytes(hdrHeader(8192, 4096) + std::string(64, '\0'))));
    std::mt19937 random(6);
    for (int round = 0; round < 20000; ++round) {
        std::string bytes = good;
        bytes[random() % bytes.size()] = static_cast<char>(random());
        (void)decodeRadianceHdr(toBytes(bytes)); // returns, and a sanitizer is content
    }
}

TEST(EnvironmentImport, RefusesWhatIsNoMap)
{
    const auto error = [](const char* path) {
        const Result<Environment> result = importEnvironment(path);
        return result ? "accepted" : result.error().message;
    };
    EXPECT_NE(error("/").find("a folder; name a file"), std::string::npos);
    EXPECT_NE(error("/nonexistent.exr").find("cannot open"), std::string::npos);
    EXPECT_NE(error("/proc/self/status").find("an empty file"), std::string::npos);
}

TEST(EnvironmentImport, NegativeAndNanBecomeZeroAndAreCounted)
{
    EnvironmentSource source = uniformSource(8, 4, vec3(1));
    source.pixels[3] = vec3(-1, 1, 1);
    source.pixels[9] = vec3(1, NAN, -2);
    const Environment e = environmentFromSource(std::move(source));
    EXPECT_EQ(e.statistics.negative, 2u);
    EXPECT_EQ(e.statistics.absurd, 0u);
    EXPECT_EQ(e.map[3], vec3(0, 1, 1));
    EXPECT_EQ(e.map[9], vec3(1, 0, 0));
}

TEST(EnvironmentImport, AbsurdPixelsAreLoweredHueKept)
{
    EnvironmentSource source = uniformSource(512, 256, vec3(1));
    source.pixels[512 * 128] = vec3(3e38f, 1.5e38f, 0);
    source.pixels[512 * 128 + 1] = vec3(kInfinity);
    const Environment e = environmentFromSource(std::move(source));
    const vec3 lowered = e.map[512 * 128];
    EXPECT_GE(e.statistics.absurd, 2u);
    EXPECT_NEAR(lowered.g / lowered.r, 0.5f, 1e-3f);
    EXPECT_EQ(e.map[512 * 128 + 2], vec3(1));
    EXPECT_LE(e.statistics.maxLuminance, kMaxEnvironmentRadiance);
    EXPECT_GT(e.statistics.clampedAt, 0.0f);
    // No pixel sends more than half of all.
    EXPECT_LT(luminance(lowered) * equirectPixelSolidAngle(512, 256, 128),
              0.501 * e.statistics.meanLuminance * 4.0 * std::numbers::pi);
}

TEST(EnvironmentImport, ALampInABlackRoomIsNotAbsurd)
{
    EnvironmentSource source = uniformSource(64, 32, vec3(0));
    source.pixels[64 * 10 + 7] = vec3(500);
    const Environment e = environmentFromSource(std::move(source));
    EXPECT_EQ(e.statistics.absurd, 0u);
    EXPECT_EQ(e.map[64 * 10 + 7], vec3(500));
}

// Power is what the filter keeps, also for sizes that the map's do not divide.
TEST(EnvironmentImport, BoxFilterKeepsThePower)
{
    for (const auto& [width, height] : {std::pair{1024u, 512u}, {1400u, 700u}, {513u, 257u}}) {
        EnvironmentSource source = uniformSource(width, height, vec3(0));
        std::mt19937 random(7);
        double power = 0.0;
        for (std::size_t i = 0; i < source.pixels.size(); ++i) {
            source.pixels[i] = vec3(static_cast<float>(random() % 1000) * 1e-3f);
            power += source.pixels[i].g *
                     equirectPixelSolidAngle(width, height, static_cast<std::uint32_t>(i / width));
        }
        const Environment e = environmentFromSource(std::move(source));
        EXPECT_EQ(e.mapWidth, 512u);
        EXPECT_EQ(e.mapHeight, 256u);
        EXPECT_NEAR(e.statistics.meanLuminance * 4 * std::numbers::pi / power, 1.0, 1e-5) << width;
        EXPECT_NEAR(e.sh4[0].g * std::sqrt(4 * std::numbers::pi) / power, 1.0, 1e-5) << width;
    }
}

void importFolder(const std::filesystem::path& folder, const char* extension, std::size_t expected)
{
    std::size_t maps = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != extension)
            continue;
        ++maps;
        const Result<Environment> e = importEnvironment(entry.path());
        ASSERT_TRUE(e) << e.error().message;
        const nlohmann::json report = nlohmann::json::parse(environmentReport(*e));
        std::printf(
            "%-22s mean %6.3f max %9.1f negative %5llu absurd %llu energy share %.3f / %.3f\n",
            entry.path().filename().c_str(), e->statistics.meanLuminance,
            e->statistics.maxLuminance, static_cast<unsigned long long>(e->statistics.negative),
            static_cast<unsigned long long>(e->statistics.absurd),
            report["energyShare"]["order4"].get<double>(),
            report["energyShare"]["order6"].get<double>());
        EXPECT_EQ(e->mapWidth, 512u);
        EXPECT_EQ(e->mapHeight, 256u);
        EXPECT_GT(e->statistics.meanLuminance, 0.0f);
        EXPECT_NEAR(luminance(e->sh4[0]) / std::sqrt(4 * std::numbers::pi),
                    e->statistics.meanLuminance, 1e-4 * e->statistics.meanLuminance);
        const Result<std::vector<std::byte>> bytes = encodeEnvironment(*e);
        ASSERT_TRUE(bytes) << bytes.error().message;
        const Result<Environment> back = decodeEnvironment(*bytes);
        ASSERT_TRUE(back) << back.error().message;
        EXPECT_EQ(back->map, e->map);
        EXPECT_EQ(back->sh6, e->sh6);
    }
    EXPECT_EQ(maps, expected);
}

TEST(EnvironmentImport, MapsOfBlenderData)
{
    const std::filesystem::path folder = "/usr/share/blender/datafiles/studiolights/world";
    ASSERT_TRUE(std::filesystem::is_directory(folder))
        << folder << " is missing: scripts/setup installs the package blender-data";
    importFolder(folder, ".exr", 8);
}

TEST(EnvironmentImport, MapsOfTheTestData)
{
    const char* data = std::getenv("PENUMBRA_TEST_DATA");
    if (data == nullptr)
        GTEST_SKIP() << "PENUMBRA_TEST_DATA is not set: no published maps to read";
    importFolder(std::filesystem::path(data) / "hdri-pmndrs-assets", ".exr", 18);
    importFolder(std::filesystem::path(data) / "hdri-1k", ".hdr", 3);
}

} // namespace

} // namespace penumbra
