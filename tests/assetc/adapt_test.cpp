#include "assetc/adapt.h"

#include "assetc/fit_shells.h"
#include "shaders/shared/field.h"
#include "tests/shared/random_sphere.h"

#include <gtest/gtest.h>

namespace penumbra {

namespace {

FieldSamples openField(std::uint32_t shells, std::uint16_t side)
{
    FieldSamples field;
    field.head.shellSides.assign(shells, side);
    field.head.directions = 64;
    field.nodes.resize(fieldTexelBytes(field.head) / kFieldCoefficients);
    return field;
}

float& c0(FieldSamples& field, std::size_t shell, std::size_t y, std::size_t x)
{
    return field.nodes[firstNode(field.head, shell) + y * field.head.shellSides[shell] + x].c[0];
}

float decayOf(const FieldSamples& field, std::size_t shell)
{
    const float r = shellRadius(field.head, shell);
    return fieldDecay(r * r);
}

using Sides = std::vector<std::uint16_t>;

} // namespace

TEST(AdaptShells, OpenFieldNeedsTwoOfTheSmallestGrids)
{
    FieldSamples field = openField(4, 65);
    const AdaptReport report = adaptShells(field, {0.01f});
    EXPECT_EQ(field.head.shellSides, (Sides{9, 0, 0, 9}));
    EXPECT_EQ(report.worst, 0);
    EXPECT_EQ(report.shellsDropped, 2u);
    EXPECT_EQ(report.bytesFixed, 4u * 65 * 65 * 16);
    EXPECT_EQ(report.bytes, 2u * 9 * 9 * 16);
    EXPECT_TRUE(validateField(quantiseField(field)));
}

// One node between those of the coarser grid differs in c_0 alone: Eq. (1) is |dc_0| Y_00. The mean
// around the neighbouring nodes takes a sixteenth of it along.
TEST(AdaptShells, ThresholdIsEquationOne)
{
    for (const float factor : {0.99f, 1.01f}) {
        FieldSamples field = openField(3, 17);
        c0(field, 1, 5, 5) = 0.3f;
        const float error = 0.3f * 0.282094792f * (1 - 1.0f / 16);
        const AdaptReport report = adaptShells(field, {factor * error});
        EXPECT_EQ(field.head.shellSides[0], 9);
        EXPECT_EQ(field.head.shellSides[1], factor < 1 ? 17 : 9);
        EXPECT_EQ(field.head.shellSides[2], 9);
        // The fit of the nodes left takes a little off it.
        EXPECT_GE(report.worst, factor < 1 ? 0 : 0.9f * error);
        EXPECT_LE(report.worst, factor < 1 ? 0 : error);
    }
}

// A detail on a node that the coarser grids keep is worth their side: what counts is the whole
// neighbourhood.
TEST(AdaptShells, PeakOnAKeptNodeStillNeedsTheFineGrid)
{
    FieldSamples field = openField(2, 33);
    c0(field, 0, 8, 8) = 1;
    adaptShells(field, {1e-3f});
    EXPECT_EQ(field.head.shellSides, (Sides{33, 9}));
    EXPECT_EQ(c0(field, 0, 8, 8), 1);
}

TEST(AdaptShells, NodesInsideTheObjectDoNotCount)
{
    FieldSamples field = openField(2, 33);
    c0(field, 0, 8, 8) = 1;
    field.inside.assign(field.nodes.size(), false);
    field.inside[8 * 33 + 8] = true;
    adaptShells(field, {1e-3f});
    // The peak spreads to nodes that do count where the coarser grid keeps it.
    EXPECT_GT(field.head.shellSides[0], 9);
    field = openField(2, 33);
    c0(field, 0, 9, 9) = 0.01f;
    field.inside.assign(field.nodes.size(), false);
    field.inside[9 * 33 + 9] = true;
    adaptShells(field, {1e-3f});
    EXPECT_EQ(field.head.shellSides, (Sides{9, 9}));
}

// Between shells readers interpolate c / g(r), so a shell that lies on that line is not needed.
TEST(AdaptShells, DropsShellsThatTheirNeighboursGive)
{
    FieldSamples field = openField(5, 9);
    const auto set = [&](std::size_t shell, float steps) {
        for (std::size_t i = 0; i < 81; ++i)
            field.nodes[81 * shell + i].c[0] = steps * decayOf(field, shell);
    };
    for (std::size_t s = 0; s < 5; ++s)
        set(s, -0.2f - 0.1f * static_cast<float>(s));
    FieldSamples bent = field;
    const AdaptReport report = adaptShells(field, {1e-4f});
    EXPECT_EQ(field.head.shellSides, (Sides{9, 0, 0, 0, 9}));
    EXPECT_LT(report.worst, 1e-6f);

    for (std::size_t i = 0; i < 81; ++i)
        bent.nodes[81 * 2 + i].c[0] -= 0.1f;
    adaptShells(bent, {1e-4f});
    EXPECT_EQ(bent.head.shellSides, Sides(5, 9));
}

// Straight lines between values of a curve all lie on one side of it; the fit takes most of that
// away, and moves nodes that lie twice on the octahedral map alike.
TEST(AdaptShells, FitLeavesNoBias)
{
    FieldSamples field = openField(3, 33);
    const auto curve = [](vec3 d, float shell) { return -1.2f - 0.8f * d.z * d.z - shell * shell; };
    for (std::size_t s = 0; s < 3; ++s)
        for (std::size_t i = 0; i < 33 * 33; ++i) {
            const vec3 d = octahedralDirection(vec2(i % 33, i / 33) / 32.0f);
            c0(field, s, i / 33, i % 33) =
                decayOf(field, s) * curve(d, 0.05f * static_cast<float>(s));
        }
    const FieldSamples fine = field;
    adaptShells(field, {0.05f});
    ASSERT_LT(field.head.shellSides[0], 33);
    const std::vector<Sh4> read = refineNodes(field, 0, 33);
    double bias = 0, squares = 0;
    for (std::size_t i = 0; i < read.size(); ++i) {
        const double off = read[i].c[0] - fine.nodes[i].c[0] / decayOf(fine, i / (33 * 33));
        bias += off / static_cast<double>(read.size());
        squares += off * off / static_cast<double>(read.size());
    }
    EXPECT_GT(squares, 0);
    EXPECT_LT(std::abs(bias), 0.25 * std::sqrt(squares));
    const std::uint32_t side = field.head.shellSides[0];
    for (std::uint32_t i = 0; i < side; ++i)
        EXPECT_FLOAT_EQ(c0(field, 0, 0, i), c0(field, 0, 0, side - 1 - i));
}

TEST(Coarsened, IsCloserToTheFineFieldThanItsNodes)
{
    FieldSamples fine = openField(2, 33);
    fine.head.shellSides = {17, 33};
    fine.nodes.resize(17 * 17 + 33 * 33);
    fine.inside.assign(fine.nodes.size(), false);
    fine.inside[2 * 17 + 4] = true;
    for (std::size_t s = 0; s < 2; ++s)
        for (std::size_t i = 0; i < (s == 0 ? 17 * 17 : 33 * 33); ++i) {
            const std::size_t side = fine.head.shellSides[s];
            const vec2 uv = vec2(i % side, i / side) / static_cast<float>(side - 1);
            c0(fine, s, i / side, i % side) = -1 - std::sin(3 * octahedralDirection(uv).x);
        }
    const FieldSamples coarse = coarsened(fine, 17);
    EXPECT_EQ(coarse.head.shellSides, (Sides{17, 17}));
    ASSERT_EQ(coarse.inside.size(), 2u * 17 * 17);
    EXPECT_TRUE(coarse.inside[2 * 17 + 4]);
    EXPECT_EQ(std::count(coarse.inside.begin(), coarse.inside.end(), true), 1);
    for (std::size_t i = 0; i < 17 * 17; ++i) // nothing to gain
        EXPECT_NEAR(coarse.nodes[i].c[0], fine.nodes[i].c[0], 1e-5f);

    std::vector<Sh4> kept, fitted(coarse.nodes.begin() + 17 * 17, coarse.nodes.end());
    for (std::size_t y = 0; y < 33; y += 2)
        for (std::size_t x = 0; x < 33; x += 2)
            kept.push_back(fine.nodes[17 * 17 + y * 33 + x]);
    const auto squares = [&](const std::vector<Sh4>& grid) {
        const std::vector<Sh4> read = refineNodes(grid, 17, 33);
        double sum = 0;
        for (std::size_t i = 0; i < read.size(); ++i)
            sum += std::pow(read[i].c[0] - fine.nodes[17 * 17 + i].c[0], 2);
        return sum;
    };
    EXPECT_LT(squares(fitted), 0.6 * squares(kept));
}

TEST(AdaptShells, ChannelsKeepOneSide)
{
    FieldSamples field = openField(2, 17);
    field.head.kind = FieldKind::Radiance;
    field.head.channels = 3;
    field.nodes.resize(fieldTexelBytes(field.head) / kFieldCoefficients);
    field.nodes[2 * 17 * 17 + 5 * 17 + 5].c[0] = 1; // channel 1, shell 0
    adaptShells(field, {0.01f});
    EXPECT_EQ(field.head.shellSides, (Sides{17, 9}));
    EXPECT_EQ(field.nodes.size(), 3u * (17 * 17 + 9 * 9));
    EXPECT_EQ(field.nodes[(17 * 17 + 9 * 9) + 5 * 17 + 5].c[0], 1);
    EXPECT_TRUE(validateField(quantiseField(field)));
}

// What readers make of bytes is what assetc measures of samples, to half a step.
TEST(RefineField, LeftOutShellsAreLinearInTheSteps)
{
    ShadowField field;
    field.shellSides = {3, 0, 0, 5};
    field.bandScale = {0.01f, 0.01f, 0.01f, 0.01f};
    field.texels.assign(16 * (9 + 25), 100);
    std::fill(field.texels.begin() + 16 * 9, field.texels.end(), 160);
    ASSERT_TRUE(validateField(field));
    const std::vector<std::uint8_t> fine = refineField(field, 0);
    ASSERT_EQ(fine.size(), 4u * 25 * 16);
    for (std::size_t s = 0; s < 4; ++s)
        for (std::size_t i = 0; i < 25 * 16; ++i)
            EXPECT_EQ(fine[s * 25 * 16 + i], 100 + 20 * s);
    for (const Sides& sides : {Sides{0, 3, 3}, Sides{3, 3, 0}}) {
        field.shellSides = sides;
        field.texels.assign(fieldTexelBytes(field), 128);
        EXPECT_FALSE(validateField(field));
    }
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
