#include "assets/field_payload.h"

#include "tests/assets/sample_assets.h"

#include <gtest/gtest.h>

namespace penumbra {

// Deltas wrap modulo 256; all values at all places of the grid survive.
TEST(FieldPayload, RoundTripOverAllValues)
{
    ShadowField field = sampleField();
    field.shellSides = {3, 9, 5};
    field.channels = 3;
    field.kind = FieldKind::Radiance;
    field.frames = 2;
    field.texels.resize(fieldTexelBytes(field));
    std::mt19937 random(3);
    for (int round = 0; round < 4; ++round) {
        for (std::size_t i = 0; i < field.texels.size(); ++i)
            field.texels[i] = round == 0   ? static_cast<std::uint8_t>(i)
                              : round == 1 ? static_cast<std::uint8_t>(i % 2 == 0 ? 0 : 255)
                                           : static_cast<std::uint8_t>(random());
        const auto decoded = decodeFieldTexels(field, encodeFieldTexels(field));
        ASSERT_TRUE(decoded) << decoded.error().message;
        EXPECT_EQ(*decoded, field.texels);
    }
}

TEST(FieldPayload, SmoothFieldsShrink)
{
    ShadowField field = sampleField();
    field.shellSides = {33, 33};
    field.texels.resize(fieldTexelBytes(field));
    for (std::size_t i = 0; i < field.texels.size(); ++i)
        field.texels[i] = static_cast<std::uint8_t>(i % 16 + i / 16 / 33); // a gradient along y
    EXPECT_LT(encodeFieldTexels(field).size(), field.texels.size() / 20);
}

// The size in the zstd frame is checked against the head before anything is allocated.
TEST(FieldPayload, SizeThatDisagreesWithTheHeadIsRefused)
{
    ShadowField field = sampleField();
    const auto bytes = encodeFieldTexels(field);
    field.shellSides = {5, 5};
    EXPECT_FALSE(decodeFieldTexels(field, bytes));
    EXPECT_FALSE(decodeFieldTexels(field, {}));
}

TEST(FieldPayload, EveryTruncationIsRefused)
{
    const ShadowField field = sampleField();
    const auto bytes = encodeFieldTexels(field);
    for (std::size_t length = 0; length < bytes.size(); ++length) {
        const std::vector<std::byte> cut(bytes.begin(),
                                         bytes.begin() + static_cast<std::ptrdiff_t>(length));
        EXPECT_FALSE(decodeFieldTexels(field, cut)) << length;
    }
}

} // namespace penumbra
