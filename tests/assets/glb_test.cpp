#include "assets/glb.h"

#include <cstring>
#include <gtest/gtest.h>

namespace penumbra {

namespace {

std::vector<std::byte> sample()
{
    const std::vector<std::byte> bin(5, std::byte{7});
    return *writeGlb("{\"a\":1}", bin);
}

void setWord(std::vector<std::byte>& bytes, std::size_t at, std::uint32_t value)
{
    std::memcpy(bytes.data() + at, &value, sizeof value);
}

} // namespace

TEST(Glb, RoundTripPadsToFourBytes)
{
    const auto bytes = sample();
    EXPECT_EQ(bytes.size() % 4, 0u);
    const auto view = readGlb(bytes);
    ASSERT_TRUE(view) << view.error().message;
    EXPECT_EQ(view->json, "{\"a\":1} ");
    ASSERT_EQ(view->bin.size(), 8u);
    EXPECT_EQ(view->bin[4], std::byte{7});
    EXPECT_EQ(view->bin[5], std::byte{0});
}

TEST(Glb, FileWithoutBinChunk)
{
    const auto bytes = *writeGlb("{}", {});
    const auto view = readGlb(bytes);
    ASSERT_TRUE(view);
    EXPECT_TRUE(view->bin.empty());
}

TEST(Glb, RefusesBrokenContainers)
{
    const auto refuses = [](std::size_t at, std::uint32_t word) {
        auto bytes = sample();
        setWord(bytes, at, word);
        return !readGlb(bytes);
    };
    EXPECT_TRUE(refuses(0, 0));            // magic
    EXPECT_TRUE(refuses(4, 1));            // version
    EXPECT_TRUE(refuses(8, 1000));         // file length
    EXPECT_TRUE(refuses(8, 12));           //
    EXPECT_TRUE(refuses(12, 0xfffffff0));  // JSON length
    EXPECT_TRUE(refuses(12, 0));           //
    EXPECT_TRUE(refuses(16, 0x004e4942));  // BIN first
    EXPECT_TRUE(refuses(28, 0xffffffff));  // BIN length
    EXPECT_TRUE(refuses(32, 0x4e4f534a));  // JSON twice
    EXPECT_FALSE(refuses(32, 0x12345678)); // an unknown chunk is skipped
}

TEST(Glb, EveryTruncationIsRefused)
{
    const auto bytes = sample();
    for (std::size_t length = 0; length < bytes.size(); ++length) {
        const std::vector<std::byte> cut(bytes.begin(),
                                         bytes.begin() + static_cast<std::ptrdiff_t>(length));
        EXPECT_FALSE(readGlb(cut)) << length;
    }
}

} // namespace penumbra
