#include "shaders/shared/transfer.h"

#include "tests/shared/random_sphere.h"

#include <gtest/gtest.h>

namespace penumbra {
namespace {

Sh4 one()
{
    Sh4 f{};
    f.c[0] = kSqrt4Pi;
    return f;
}

// A clamped cosine's projection, against numbers: band l of max(0, cos) integrates to A_l sqrt((2l+1)/(4 pi)) on axis.
TEST(Transfer, CosineLobeIsTheProjectionOfTheClampedCosine)
{
    RandomSphere random(1);
    const vec3 n = random.direction();
    const Sh4 lobe = cosineLobe(n);
    double projected[16] = {};
    constexpr int kSamples = 400000;
    for (int i = 0; i < kSamples; ++i) { // Fibonacci lattice
        const double z = 1 - (2 * i + 1.0) / kSamples, s = std::sqrt(1 - z * z), phi = 2.399963229728653 * i;
        const vec3 d(s * std::cos(phi), s * std::sin(phi), z);
        const Sh4 y = shBasis(d);
        for (int k = 0; k < 16; ++k)
            projected[k] += std::max(0.0f, dot(n, d)) * y.c[k] * 4 * M_PI / kSamples;
    }
    for (int k = 0; k < 16; ++k)
        EXPECT_NEAR(lobe.c[k], projected[k], 1e-4) << k;
}

TEST(Transfer, PhongLobeIsTheProjectionOfThePower)
{
    RandomSphere random(2);
    const vec3 r = random.direction();
    for (const float e : {1.0f, 4.0f, 12.0f}) {
        const Sh4 lobe = phongLobe(r, e);
        double projected[16] = {};
        constexpr int kSamples = 400000;
        for (int i = 0; i < kSamples; ++i) {
            const double z = 1 - (2 * i + 1.0) / kSamples, s = std::sqrt(1 - z * z), phi = 2.399963229728653 * i;
            const vec3 d(s * std::cos(phi), s * std::sin(phi), z);
            const Sh4 y = shBasis(d);
            const double value = (e + 2) / (2 * M_PI) * std::pow(std::max(0.0f, dot(r, d)), e);
            for (int k = 0; k < 16; ++k)
                projected[k] += value * y.c[k] * 4 * M_PI / kSamples;
        }
        for (int k = 0; k < 16; ++k)
            EXPECT_NEAR(lobe.c[k], projected[k], 2e-4) << e << ' ' << k;
    }
}

// White furnace: under radiance 1 an open Lambert receiver reflects its albedo, in both forms.
TEST(Transfer, EnergyOfAnOpenLambertReceiver)
{
    RandomSphere random(3);
    Receiver receiver{vec3(0), random.direction(), random.direction(), 0, 0};
    const ShNodal nodal = transferNodal(one(), receiver);
    float sum = 0;
    for (int n = 0; n < 32; ++n)
        sum += kShNodes[n].w * nodal.v[n];
    EXPECT_NEAR(sum, 1, 1e-5);
    EXPECT_NEAR(shDot(transferSh(one(), receiver), one()), 1, 1e-5);
}

// At normal incidence the glossy lobe is cos^(e+1) about the normal and reflects all. Both factors are band-limited before
// the product, which costs 2.4 % at e = 2; the products themselves are exact.
TEST(Transfer, EnergyOfAGlossyReceiverAtNormalIncidence)
{
    RandomSphere random(4);
    const vec3 n = random.direction();
    for (const float e : {2.0f, 6.0f}) {
        const float energy = shDot(transferSh(one(), Receiver{vec3(0), n, n, 1, e}), one());
        EXPECT_NEAR(energy, shDot(phongLobe(n, e), cosineLobe(n)), 1e-5) << e;
        EXPECT_NEAR(energy, 1, 0.025) << e;
    }
}

TEST(Transfer, NodalAndShFormsAgree)
{
    RandomSphere random(5);
    for (int trial = 0; trial < 50; ++trial) {
        Sh4 visibility = one();
        const Sh4 noise = random.function();
        for (int k = 0; k < 16; ++k)
            visibility.c[k] += 0.2f * noise.c[k];
        const Receiver receiver{vec3(0), random.direction(), random.direction(), 0, 0};
        const Sh4 light = random.function();
        const ShNodal nodal = transferNodal(visibility, receiver);
        float sum = 0;
        for (int n = 0; n < 32; ++n)
            sum += kShNodes[n].w * nodal.v[n] * evaluate(light, vec3(kShNodes[n]));
        EXPECT_NEAR(sum, shDot(transferSh(visibility, receiver), light), 1e-5);
    }
}

TEST(Transfer, SelfVisibilityOfAnOpenVertexIsOne)
{
    const Sh4 v = selfVisibility(uvec4(0x80808080u), 0.01f);
    EXPECT_EQ(v.c[0], kSqrt4Pi);
    for (int k = 1; k < 16; ++k)
        EXPECT_EQ(v.c[k], 0);
}

} // namespace
} // namespace penumbra
