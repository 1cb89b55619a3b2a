#include "assetc/adapt.h"

#include "shaders/shared/field.h"
#include "tests/shared/random_sphere.h"

#include <gtest/gtest.h>

namespace penumbra {

namespace {

// Every byte 128, which is "nothing in the way"; K = 0.01 in all bands.
ShadowField openField(std::uint32_t shells, std::uint16_t side)
{
    ShadowField field;
    field.bandScale = {0.01f, 0.01f, 0.01f, 0.01f};
    field.shellSides.assign(shells, side);
    field.directions = 64;
    field.texels.assign(fieldTexelBytes(field), 128);
    return field;
}

std::uint8_t& byteOf(ShadowField& field, std::size_t shell, std::size_t y, std::size_t x)
{
    const std::size_t side = field.shellSides[0];
    return field.texels[((shell * side + y) * side + x) * kFieldCoefficients];
}

float decayOf(const ShadowField& field, std::size_t shell)
{
    const float r =
        field.innerRadius *
        std::pow(field.outerRadius / field.innerRadius,
                 static_cast<float>(shell) / static_cast<float>(field.shellSides.size() - 1));
    return fieldDecay(r * r);
}

} // namespace

TEST(AdaptShells, ConstantShellsShrinkToTheSmallestGrid)
{
    ShadowField field = openField(4, 65);
    const AdaptReport report = adaptShells(field, 0.01f);
    EXPECT_EQ(field.shellSides, std::vector<std::uint16_t>(4, kMinAdaptedSide));
    EXPECT_EQ(report.worst, 0);
    EXPECT_EQ(report.bytesBefore, 4u * 65 * 65 * 16);
    EXPECT_EQ(report.bytesAfter, 4u * 9 * 9 * 16);
    EXPECT_TRUE(validateField(field));
}

// One node between those of the coarser grid differs in c_0 alone: Eq. (1) is |dc_0| Y_00.
TEST(AdaptShells, ThresholdIsEquationOne)
{
    for (const float factor : {0.99f, 1.01f}) {
        ShadowField field = openField(3, 17);
        byteOf(field, 1, 5, 5) = 228;
        const float error = 100 * 0.01f * decayOf(field, 1) * 0.282094792f;
        const AdaptReport report = adaptShells(field, factor * error);
        EXPECT_EQ(field.shellSides[0], 9);
        EXPECT_EQ(field.shellSides[1], factor < 1 ? 17 : 9);
        EXPECT_EQ(field.shellSides[2], 9);
        EXPECT_NEAR(report.worst, factor < 1 ? 0 : error, 1e-5f * error);
    }
}

// A detail on a node that the coarser grids keep is worth their side: what counts is the whole
// neighbourhood.
TEST(AdaptShells, PeakOnAKeptNodeStillNeedsTheFineGrid)
{
    ShadowField field = openField(2, 33);
    byteOf(field, 0, 8, 8) = 255;
    adaptShells(field, 1e-3f);
    EXPECT_EQ(field.shellSides[0], 33);
    EXPECT_EQ(byteOf(field, 0, 8, 8), 255);
    EXPECT_EQ(field.shellSides[1], 9);
}

TEST(AdaptShells, ChannelsKeepOneSide)
{
    ShadowField field = openField(2, 17);
    field.kind = FieldKind::Radiance;
    field.channels = 3;
    field.texels.assign(fieldTexelBytes(field), 128);
    field.texels[(2 * 17 * 17 + 5 * 17 + 5) * 16] = 255; // channel 1, shell 0
    adaptShells(field, 0.01f);
    EXPECT_EQ(field.shellSides, (std::vector<std::uint16_t>{17, 9}));
    EXPECT_EQ(field.texels.size(), 3u * 16 * (17 * 17 + 9 * 9));
    EXPECT_EQ(field.texels[((17 * 17 + 9 * 9) + 5 * 17 + 5) * 16], 255);
    EXPECT_TRUE(validateField(field));
}

TEST(RefineGrid, KeepsNodesAndInterpolatesBetween)
{
    RandomSphere random(1);
    std::vector<std::uint8_t> grid(5 * 5 * 16);
    for (std::uint8_t& byte : grid)
        byte = static_cast<std::uint8_t>(random.uniform(0, 255.99f));
    EXPECT_EQ(refineGrid(grid, 5, 5), grid);
    const std::vector<std::uint8_t> fine = refineGrid(grid, 5, 9);
    for (std::size_t y = 0; y < 9; ++y)
        for (std::size_t x = 0; x < 9; ++x)
            for (std::size_t k = 0; k < 16; ++k) {
                float sum = 0;
                for (const std::size_t dy : {y / 2, (y + 1) / 2})
                    for (const std::size_t dx : {x / 2, (x + 1) / 2})
                        sum += grid[(dy * 5 + dx) * 16 + k];
                EXPECT_EQ(fine[(y * 9 + x) * 16 + k], std::lround(sum / 4));
            }
}

} // namespace penumbra
