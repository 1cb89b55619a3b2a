#include "shaders/shared/instance.h"
#include "shaders/shared/transfer.h"

#include "tests/shared/random_sphere.h"

#include <cstring>
#include <gtest/gtest.h>

namespace penumbra {
namespace {

FieldGrid gridOf(uint side, uint shells)
{
    const float scale = static_cast<float>(shells - 1) / std::log2(8.0f / 0.2f);
    return {0, side, scale, -scale * std::log2(0.2f), static_cast<float>(shells - 1), shells};
}

TEST(Field, OctahedralMapReturns)
{
    RandomSphere random(1);
    for (int i = 0; i < 1000; ++i) {
        const vec3 d = random.direction();
        EXPECT_LT(length(octahedralDirection(octahedralUv(d)) - d), 2e-6);
    }
    for (const vec3 axis : {vec3(0, 0, 1), vec3(0, 0, -1), vec3(1, 0, 0), vec3(0, -1, 0)})
        EXPECT_LT(length(octahedralDirection(octahedralUv(axis)) - axis), 1e-6);
}

// Half a step of each coordinate, (1, 1, -2) / 65535 before normalising, where that stretches most:
// the face centres.
TEST(Field, PackedNormalIsWithinHalfAStep)
{
    RandomSphere random(2);
    for (int i = 0; i < 1000; ++i) {
        const vec3 n = random.direction();
        EXPECT_LT(length(unpackNormal(packNormal(n)) - n),
                  std::sqrt(6.0f) / 65535 * std::sqrt(3.0f));
    }
}

// The node that a sample was baked at is found again, with weight 1 there.
TEST(Field, NodesSampleThemselves)
{
    const FieldGrid grid = gridOf(17, 8);
    for (uint shell = 0; shell < 7; ++shell) { // the last one has faded to nothing
        const float r = 0.2f * std::pow(40.0f, static_cast<float>(shell) / 7);
        for (uint y = 0; y < 17; ++y) {
            for (uint x = 0; x < 17; ++x) {
                const vec3 d = octahedralDirection(vec2(x, y) / 16.0f);
                const FieldCell cell = fieldCell(r * d, grid);
                float weight = 0;
                for (uint corner = 0; corner < 8; ++corner) {
                    const uint sample = cell.sample0 + fieldCornerOffset(corner, grid);
                    const uint ss = sample % 8, sx = sample / 8 % 17, sy = sample / 8 / 17;
                    const vec3 node = octahedralDirection(
                        vec2(sx, sy) / 16.0f); // the folded edges name one direction twice
                    if (ss == shell && length(node - d) < 1e-3f)
                        weight += fieldCornerWeight(corner, cell.fraction);
                }
                EXPECT_NEAR(weight, 1, 2e-3) << shell << ' ' << y << ' ' << x;
            }
        }
    }
}

TEST(Field, CellStaysInsideTheGrid)
{
    RandomSphere random(3);
    const FieldGrid grid = gridOf(65, 32);
    const auto samples = static_cast<uint>(65 * 65 * 32);
    for (int i = 0; i < 20000; ++i) {
        const vec3 p = random.direction() * std::pow(10.0f, random.uniform(-8, 3));
        const FieldCell cell = fieldCell(p, grid);
        const FieldTetrahedron t = fieldTetrahedron(cell.fraction, grid);
        ASSERT_LT(cell.sample0 + fieldCornerOffset(7, grid), samples);
        ASSERT_LT(cell.sample0 + std::max({t.offset.x, t.offset.y, t.offset.z, t.offset.w}),
                  samples);
        ASSERT_EQ(t.weight.x + t.weight.y + t.weight.z + t.weight.w, 256u);
        ASSERT_TRUE(std::isfinite(cell.decay));
    }
    EXPECT_LT(fieldCell(vec3(0), grid).sample0, samples); // the centre itself
}

// Tetrahedra and cells agree on functions that are linear in the cell, up to the weights' 1/256.
TEST(Field, TetrahedronReproducesLinearFunctions)
{
    RandomSphere random(4);
    for (int i = 0; i < 2000; ++i) {
        const vec3 f(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1));
        const vec3 slope(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        const FieldTetrahedron t = fieldTetrahedron(f, gridOf(65, 32));
        float sum = 0;
        for (int c = 0; c < 4; ++c) {
            const uint o = t.offset[c];
            const vec3 corner(o / 32 % 65, o / (32 * 65), o % 32);
            sum += static_cast<float>(t.weight[c]) / 256.0f * dot(slope, corner);
        }
        EXPECT_NEAR(sum, dot(slope, f), 3.0 / 512 + 1e-5);
    }
}

// All byte values in all lanes: packed 16-bit arithmetic neither overflows nor mixes lanes.
TEST(Field, BlendEqualsPlainArithmetic)
{
    RandomSphere random(5);
    for (int trial = 0; trial < 3000; ++trial) {
        std::uint8_t bytes[4][16];
        for (auto& sample : bytes)
            for (auto& byte : sample)
                byte = trial == 0   ? 255
                       : trial == 1 ? 0
                                    : static_cast<std::uint8_t>(random.uniform(0, 255.99f));
        const FieldTetrahedron t = fieldTetrahedron(
            vec3(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)), gridOf(65, 32));
        uvec4 s[4];
        std::memcpy(s, bytes, sizeof(bytes));
        const Sh4 blended = fieldBlend(s[0], s[1], s[2], s[3], t.weight);
        for (int k = 0; k < 16; ++k) {
            int sum = -128 * 256;
            for (int c = 0; c < 4; ++c)
                sum += bytes[c][k] * static_cast<int>(t.weight[c]);
            EXPECT_EQ(blended.c[k], static_cast<float>(sum));
        }
    }
}

TEST(Field, StepsOfAllBytes)
{
    for (int q = 0; q < 256; ++q) {
        const uint word = static_cast<uint>(q) * 0x01010101u;
        const Sh4 steps = fieldSteps(uvec4(word));
        for (const float c : steps.c)
            EXPECT_EQ(c, static_cast<float>(q - 128));
    }
}

// Beyond the last shell nothing is hidden, and on the way there nothing jumps.
TEST(Field, FadesOutWithoutAStep)
{
    const FieldGrid grid = gridOf(17, 8);
    EXPECT_NEAR(fieldCell(vec3(0, 0, 8.0f), grid).decay, 0, 1e-7);
    EXPECT_EQ(fieldCell(vec3(0, 0, 100.0f), grid).decay, 0);
    float last = fieldCell(vec3(0, 0, 4.0f), grid).decay;
    for (float r = 4.001f; r < 8.2f; r += 0.001f) {
        const float decay = fieldCell(vec3(0, 0, r), grid).decay;
        EXPECT_LE(decay, last);
        EXPECT_LT(last - decay, 2e-4);
        last = decay;
    }
}

TEST(Instance, FieldFrameFollowsTheTransform)
{
    RandomSphere random(6);
    for (int trial = 0; trial < 100; ++trial) {
        const mat3 r = random.rotation();
        const quat q = glm::quat_cast(r);
        InstanceInput input{};
        input.position = 3.0f * random.direction();
        input.scale = random.uniform(0.2f, 4);
        input.rotation = vec4(q.x, q.y, q.z, q.w);
        FieldInput field{};
        field.center = random.direction();
        field.radius = random.uniform(0.1f, 2);
        field.side = 65;
        field.shells = 32;
        field.innerRadius = 0.2f;
        field.outerRadius = 8;
        const GpuInstance g = makeInstance(input, field);
        const vec3 local = random.direction(); // bounding radii, field axes
        const vec3 world =
            input.position + input.scale * (r * (field.center + field.radius * local));
        const FieldEntity e = instanceField(g);
        EXPECT_LT(length(fieldPoint(e, world) - local), 5e-5);
        EXPECT_NEAR(length(world - vec3(g.sphere)), g.sphere.w, 1e-4);
        EXPECT_EQ(e.grid.side, 65u);

        const Sh4 f = random.function();
        const Sh4 a = shRotate(f, e.rotation);
        const Sh4 b = shRotateDense(f, denseRotation(e.rotation));
        for (int i = 0; i < 16; ++i)
            EXPECT_NEAR(a.c[i], b.c[i], 1e-5);
    }
}

} // namespace
} // namespace penumbra
