#include "assets/shadow_field.h"

#include "tests/assets/sample_assets.h"

#include <gtest/gtest.h>

namespace penumbra {

TEST(ShadowField, TexelBytesCountsShellsChannelsAndFrames)
{
    ShadowField field = sampleField();
    EXPECT_EQ(fieldTexelBytes(field), (25u + 9u) * 16u);
    field.channels = 3;
    field.frames = 4;
    EXPECT_EQ(fieldTexelBytes(field), (25u + 9u) * 16u * 12u);
}

TEST(ShadowField, AcceptsEverySideOfTheForm2kPlus1)
{
    for (std::uint32_t side = 0; side <= 300; ++side) {
        ShadowField field = sampleField();
        field.shellSides = {static_cast<std::uint16_t>(side), 3};
        field.texels.resize(fieldTexelBytes(field));
        const bool expected = side == 3 || side == 5 || side == 9 || side == 17 || side == 33 ||
                              side == 65 || side == 129 || side == 257;
        EXPECT_EQ(validateField(field).ok(), expected) << side;
    }
}

TEST(ShadowField, RefusesEachBrokenInvariant)
{
    const float nan = std::nanf("");
    const auto refuses = [](auto&& spoil) {
        ShadowField field = sampleField();
        spoil(field);
        return !validateField(field);
    };
    EXPECT_FALSE(refuses([](ShadowField&) {}));
    EXPECT_TRUE(refuses([](ShadowField& f) { f.kind = static_cast<FieldKind>(7); }));
    EXPECT_TRUE(refuses([](ShadowField& f) { f.channels = 3; })); // occlusion has one
    EXPECT_TRUE(refuses([](ShadowField& f) { f.channels = 0; }));
    EXPECT_TRUE(refuses([](ShadowField& f) { f.frames = 0; }));
    EXPECT_TRUE(refuses([&](ShadowField& f) { f.center.z = nan; }));
    EXPECT_TRUE(refuses([](ShadowField& f) { f.radius = 0; }));
    EXPECT_TRUE(refuses([&](ShadowField& f) { f.radius = nan; }));
    const auto refusesBall = [&](vec4 ball, FieldKind kind = FieldKind::Occlusion) {
        return refuses([&](ShadowField& f) {
            f.inscribed = ball;
            f.kind = kind;
        });
    };
    EXPECT_FALSE(refusesBall({0.5f, -0.2f, 0.3f, 0.8f}));
    EXPECT_TRUE(refusesBall({0.5f, -0.2f, 0.3f, 0.9f})); // beyond the bounding sphere
    EXPECT_TRUE(refusesBall({0.5f, -0.2f, 0.3f, 0.8f}, FieldKind::Radiance));
    EXPECT_TRUE(refusesBall({0, 0, 0, -1}));
    EXPECT_TRUE(refusesBall({0, 0, 0, nan}));
    EXPECT_TRUE(refusesBall({0, nan, 0, 0}));
    EXPECT_TRUE(refusesBall({0, 0, 0, INFINITY}));
    EXPECT_TRUE(refuses([](ShadowField& f) { f.innerRadius = 9; })); // beyond the outer one
    EXPECT_TRUE(refuses([](ShadowField& f) { f.outerRadius = INFINITY; }));
    EXPECT_TRUE(refuses([&](ShadowField& f) { f.bandScale[2] = nan; }));
    EXPECT_TRUE(refuses([](ShadowField& f) { f.bandScale[2] = -1; }));
    EXPECT_TRUE(refuses([](ShadowField& f) { f.shellSides = {5}; }));
    EXPECT_TRUE(refuses([](ShadowField& f) { f.shellSides.assign(200, 3); }));
    EXPECT_TRUE(refuses([](ShadowField& f) { f.texels.push_back(0); }));
    EXPECT_TRUE(refuses([](ShadowField& f) { f.directions = 1u << 30; }));
}

// 128 shells of 257² and 1024 frames would be 138 GB: refused from the head alone.
TEST(ShadowField, HugeFieldIsRefusedBeforeItsTexelsExist)
{
    ShadowField field = sampleField();
    field.shellSides.assign(kMaxFieldShells, 257);
    field.frames = kMaxFieldFrames;
    EXPECT_FALSE(validateFieldHead(field));
}

} // namespace penumbra
