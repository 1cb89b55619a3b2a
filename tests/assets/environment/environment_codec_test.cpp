// The .env format: round trip, byte fixture, every truncation, rejections, fuzz.
#include "assets/environment.h"

#include <algorithm>
#include <cstring>
#include <gtest/gtest.h>
#include <memory>
#include <random>
#define XXH_INLINE_ALL
#include <xxhash.h>

namespace penumbra {

namespace {

Environment smallEnvironment()
{
    std::vector<vec3> map;
    for (int i = 0; i < 8; ++i)
        map.emplace_back(0.1f * i, 1.0f / (i + 1), i == 3 ? 1000.0f : 0.0f);
    Environment e = makeEnvironment(4, 2, std::move(map));
    e.statistics.sourceWidth = 4096;
    e.statistics.sourceHeight = 2048;
    e.statistics.negative = 7;
    e.statistics.absurd = 1;
    e.statistics.clampedAt = 1000.0f;
    return e;
}

std::vector<std::byte> smallBytes()
{
    return *encodeEnvironment(smallEnvironment());
}

// The checksum must not be what refuses a file whose other bytes were changed on purpose.
void seal(std::vector<std::byte>& bytes)
{
    const std::uint64_t sum = XXH64(bytes.data(), bytes.size() - 8, 0);
    std::memcpy(bytes.data() + bytes.size() - 8, &sum, 8);
}

template <class T>
std::string errorAfter(std::size_t offset, T value)
{
    std::vector<std::byte> bytes = smallBytes();
    std::memcpy(bytes.data() + offset, &value, sizeof(value));
    seal(bytes);
    const Result<Environment> decoded = decodeEnvironment(bytes);
    return decoded ? "accepted" : decoded.error().message;
}

TEST(EnvironmentCodec, RoundTripIsExact)
{
    const Environment a = smallEnvironment();
    const Result<Environment> b = decodeEnvironment(smallBytes());
    ASSERT_TRUE(b) << b.error().message;
    EXPECT_EQ(a.map, b->map);
    EXPECT_EQ(a.sh4, b->sh4);
    EXPECT_EQ(a.sh6, b->sh6);
    EXPECT_EQ(b->mapWidth, 4u);
    EXPECT_EQ(b->mapHeight, 2u);
    EXPECT_EQ(b->statistics.sourceWidth, 4096u);
    EXPECT_EQ(b->statistics.sourceHeight, 2048u);
    EXPECT_EQ(b->statistics.negative, 7u);
    EXPECT_EQ(b->statistics.absurd, 1u);
    EXPECT_EQ(b->statistics.clampedAt, 1000.0f);
    EXPECT_EQ(b->statistics.meanLuminance, a.statistics.meanLuminance);
    EXPECT_EQ(smallBytes(), smallBytes());
}

// The contract with files that exist: version 1.0, byte for byte where no arithmetic is involved.
TEST(EnvironmentCodec, LayoutOfVersion1)
{
    const std::vector<std::byte> bytes = smallBytes();
    ASSERT_EQ(bytes.size(), 488u + 8 * 6 + 8);
    const unsigned char head[] = {'P', 'E', 'N',  'V', 1, 0, 0, 0, 4, 0, 0, 0, 2,    0,   0,
                                  0,   0,   0x10, 0,   0, 0, 8, 0, 0, 7, 0, 0, 0,    0,   0,
                                  0,   0,   1,    0,   0, 0, 0, 0, 0, 0, 0, 0, 0x7a, 0x44};
    EXPECT_EQ(std::memcmp(bytes.data(), head, sizeof(head)), 0);
    const unsigned char firstPixel[] = {0, 0, 0, 0x3c, 0, 0}; // halves 0, 1, 0
    EXPECT_EQ(std::memcmp(bytes.data() + 488, firstPixel, sizeof(firstPixel)), 0);
}

TEST(EnvironmentCodec, EveryTruncationIsRefused)
{
    const std::vector<std::byte> bytes = smallBytes();
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        const auto exact =
            std::make_unique<std::byte[]>(size); // a sanitizer sees a read past the end
        std::copy_n(bytes.data(), size, exact.get());
        EXPECT_FALSE(decodeEnvironment({exact.get(), size})) << size;
    }
}

TEST(EnvironmentCodec, RefusesWhatItCannotTrust)
{
    EXPECT_NE(errorAfter(0, 'X').find("magic"), std::string::npos);
    EXPECT_NE(errorAfter(4, std::uint16_t{2}).find("format 2.0"), std::string::npos);
    EXPECT_NE(errorAfter(8, std::uint32_t{0}).find("limit"), std::string::npos);
    EXPECT_NE(errorAfter(8, std::uint32_t{0xffffffff}).find("limit"), std::string::npos);
    EXPECT_NE(errorAfter(12, std::uint32_t{3}).find("cut or has a tail"), std::string::npos);
    EXPECT_NE(errorAfter(44, NAN).find("statistics"), std::string::npos);
    EXPECT_NE(errorAfter(52, std::uint32_t{1}).find("reserved"), std::string::npos);
    EXPECT_NE(errorAfter(56 + 12, INFINITY).find("coefficient 1"), std::string::npos);
    EXPECT_NE(errorAfter(488 + 6 * 5, std::uint16_t{0x7c00}).find("pixel (1, 1)"),
              std::string::npos);
    EXPECT_NE(errorAfter(488, std::uint16_t{0xbc00}).find("negative"), std::string::npos);
    EXPECT_EQ(errorAfter(6, std::uint16_t{9}), "accepted"); // a newer minor version
}

TEST(EnvironmentCodec, AnyFlippedBitIsNoticed)
{
    std::vector<std::byte> bytes = smallBytes();
    for (std::size_t i = 0; i < bytes.size() * 8; ++i) {
        bytes[i / 8] ^= std::byte{1} << i % 8;
        EXPECT_FALSE(decodeEnvironment(bytes)) << i;
        bytes[i / 8] ^= std::byte{1} << i % 8;
    }
}

// Sealed random damage: whatever is accepted holds the promises of assets/environment.h.
TEST(EnvironmentCodec, DamageBehindAGoodChecksumKeepsThePromises)
{
    const std::vector<std::byte> good = smallBytes();
    std::mt19937 random(4);
    for (int round = 0; round < 20000; ++round) {
        std::vector<std::byte> bytes = good;
        for (int i = 0; i < 4; ++i)
            bytes[random() % (bytes.size() - 8)] = static_cast<std::byte>(random());
        seal(bytes);
        const Result<Environment> e = decodeEnvironment(bytes);
        if (!e)
            continue;
        ASSERT_EQ(e->map.size(), std::size_t{e->mapWidth} * e->mapHeight);
        for (const vec3& c : e->map)
            ASSERT_TRUE(c.r >= 0 && c.g >= 0 && c.b >= 0 && c.r + c.g + c.b < 3 * 65505.0f);
    }
}

TEST(EnvironmentCodec, RefusesToWriteWhatItWouldNotRead)
{
    Environment e = smallEnvironment();
    e.map[2].g = -1.0f;
    EXPECT_FALSE(encodeEnvironment(e));
}

} // namespace

} // namespace penumbra
