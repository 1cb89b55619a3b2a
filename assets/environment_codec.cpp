// The bytes of a .env file; the layout is a contract, in docs/asset_format.md.
#include "assets/environment.h"

#include "assets/checksum.h"

#include <bit>
#include <cstring>
#include <glm/gtc/packing.hpp>

namespace penumbra {

namespace {

static_assert(std::endian::native == std::endian::little, "the codec copies little-endian values");

constexpr std::array<char, 4> kMagic = {'P', 'E', 'N', 'V'};
constexpr std::uint16_t kMajor = 1; // readers refuse another major version
constexpr std::uint16_t kMinor = 0;

struct Header {
    std::array<char, 4> magic;
    std::uint16_t major, minor;
    std::uint32_t mapWidth, mapHeight;
    std::uint32_t sourceWidth, sourceHeight;
    std::uint64_t negative, absurd;
    float clampedAt, meanLuminance, maxLuminance;
    std::uint32_t reserved; // 0
    float sh6[36][3];
};
static_assert(sizeof(Header) == 488 && offsetof(Header, negative) == 24 &&
              offsetof(Header, sh6) == 56);

struct HalfPixel {
    std::uint16_t r, g, b;
};
static_assert(sizeof(HalfPixel) == 6);

constexpr std::uint16_t kHalfInfinity = 0x7c00; // the halves below it are the finite ones >= 0

bool finiteAndNotNegative(float value)
{
    return std::isfinite(value) && value >= 0.0f;
}

} // namespace

Result<std::vector<std::byte>> encodeEnvironment(const Environment& environment)
{
    const EnvironmentStatistics& statistics = environment.statistics;
    Header header{kMagic,
                  kMajor,
                  kMinor,
                  environment.mapWidth,
                  environment.mapHeight,
                  statistics.sourceWidth,
                  statistics.sourceHeight,
                  statistics.negative,
                  statistics.absurd,
                  statistics.clampedAt,
                  statistics.meanLuminance,
                  statistics.maxLuminance,
                  0,
                  {}};
    std::memcpy(header.sh6, environment.sh6.data(), sizeof(header.sh6));
    const std::size_t mapBytes = environment.map.size() * sizeof(HalfPixel);
    std::vector<std::byte> bytes(sizeof(header) + mapBytes + sizeof(std::uint64_t));
    std::memcpy(bytes.data(), &header, sizeof(header));
    std::byte* at = bytes.data() + sizeof(header);
    for (const vec3& c : environment.map) {
        const HalfPixel pixel{glm::packHalf1x16(c.r), glm::packHalf1x16(c.g),
                              glm::packHalf1x16(c.b)};
        std::memcpy(at, &pixel, sizeof(pixel));
        at += sizeof(pixel);
    }
    const std::uint64_t sum =
        checksum(std::span(bytes).first(bytes.size() - sizeof(std::uint64_t)));
    std::memcpy(at, &sum, sizeof(sum));
    // What we write we can read: catches an environment that was not made by makeEnvironment.
    if (const Result<Environment> check = decodeEnvironment(bytes); !check)
        return fail(check.error(), "environment to encode");
    return bytes;
}

Result<Environment> decodeEnvironment(std::span<const std::byte> bytes)
{
    Header header;
    if (bytes.size() < sizeof(header) + sizeof(std::uint64_t))
        return Error{
            fmt::format("{} bytes, too short for an environment; compile it again", bytes.size())};
    std::memcpy(&header, bytes.data(), sizeof(header));
    if (header.magic != kMagic)
        return Error{
            "not an environment file (magic \"PENV\" missing); make one with assetc environment"};
    if (header.major != kMajor)
        return Error{
            fmt::format("environment format {}.{}, this program reads {}.x; compile it again",
                        header.major, header.minor, kMajor)};
    if (header.mapWidth < 1 || header.mapWidth > kMaxEnvironmentWidth || header.mapHeight < 1 ||
        header.mapHeight > kMaxEnvironmentHeight)
        return Error{fmt::format("map of {} x {}, the limit is {} x {}; compile it again",
                                 header.mapWidth, header.mapHeight, kMaxEnvironmentWidth,
                                 kMaxEnvironmentHeight)};
    const std::size_t pixels = std::size_t{header.mapWidth} * header.mapHeight;
    const std::size_t wanted = sizeof(header) + pixels * sizeof(HalfPixel) + sizeof(std::uint64_t);
    if (bytes.size() != wanted)
        return Error{fmt::format(
            "{} bytes, a map of {} x {} makes {}; the file is cut or has a tail; compile it again",
            bytes.size(), header.mapWidth, header.mapHeight, wanted)};
    std::uint64_t sum;
    std::memcpy(&sum, bytes.data() + wanted - sizeof(sum), sizeof(sum));
    if (sum != checksum(bytes.first(wanted - sizeof(sum))))
        return Error{"checksum differs, the file is damaged; compile it again"};
    if (!finiteAndNotNegative(header.clampedAt) || !finiteAndNotNegative(header.meanLuminance) ||
        !finiteAndNotNegative(header.maxLuminance))
        return Error{"statistics are negative or not finite; compile it again"};
    if (header.reserved != 0)
        return Error{"reserved word at byte 52 is not 0; compile it again"};

    Environment environment;
    environment.mapWidth = header.mapWidth;
    environment.mapHeight = header.mapHeight;
    environment.statistics = {header.sourceWidth, header.sourceHeight, header.negative,
                              header.absurd,      header.clampedAt,    header.meanLuminance,
                              header.maxLuminance};
    for (int k = 0; k < 36; ++k) {
        const vec3 c(header.sh6[k][0], header.sh6[k][1], header.sh6[k][2]);
        if (!std::isfinite(c.r) || !std::isfinite(c.g) || !std::isfinite(c.b))
            return Error{fmt::format("SH coefficient {} is not finite; compile it again", k)};
        environment.sh6[k] = c;
        if (k < 16)
            environment.sh4[k] = c;
    }
    environment.map.resize(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        HalfPixel p;
        std::memcpy(&p, bytes.data() + sizeof(header) + i * sizeof(p), sizeof(p));
        if (p.r >= kHalfInfinity || p.g >= kHalfInfinity || p.b >= kHalfInfinity)
            return Error{
                fmt::format("map pixel ({}, {}) is negative or not finite; compile it again",
                            i % header.mapWidth, i / header.mapWidth)};
        environment.map[i] = {glm::unpackHalf1x16(p.r), glm::unpackHalf1x16(p.g),
                              glm::unpackHalf1x16(p.b)};
    }
    return environment;
}

} // namespace penumbra
