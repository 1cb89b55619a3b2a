#include "shaders/shared/transfer.h"

#include "tests/shared/random_sphere.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace penumbra {
namespace {

Sh4 one()
{
    Sh4 f{};
    f.c[0] = kSqrt4Pi;
    return f;
}

// A clamped cosine's projection, against numbers: band l of max(0, cos) integrates to A_l
// sqrt((2l+1)/(4 pi)) on axis.
TEST(Transfer, CosineLobeIsTheProjectionOfTheClampedCosine)
{
    RandomSphere random(1);
    const vec3 n = random.direction();
    const Sh4 lobe = cosineLobe(n);
    double projected[16] = {};
    constexpr int kSamples = 400000;
    for (int i = 0; i < kSamples; ++i) { // Fibonacci lattice
        const double z = 1 - (2 * i + 1.0) / kSamples, s = std::sqrt(1 - z * z),
                     phi = 2.399963229728653 * i;
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
            const double z = 1 - (2 * i + 1.0) / kSamples, s = std::sqrt(1 - z * z),
                         phi = 2.399963229728653 * i;
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
    const ShNodal nodal = transferNodal(shNodes(one()), receiver);
    float sum = 0;
    for (int n = 0; n < 32; ++n)
        sum += kShNodes[n].w * nodal.v[n];
    EXPECT_NEAR(sum, 1, 1e-5);
    EXPECT_NEAR(shDot(transferSh(one(), receiver), one()), 1, 1e-5);
}

// At normal incidence the glossy lobe is cos^(e+1) about the normal and reflects all. Both factors
// are band-limited before the product, which costs 2.4 % at e = 2; the products themselves are
// exact.
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

// Band 4 of both lobes, against numbers: the integral with P_4 over the sphere.
TEST(Transfer, PolynomialsAreTheLobesUpToBandFour)
{
    const auto exact = [](float e, double t) {
        return t <= 0 ? 0 : e == 0 ? t : (e + 2) / (2 * M_PI) * std::pow(t, e);
    };
    for (const float e : {0.0f, 2.0f, 5.0f}) { // 0: the cosine
        const ZonalPolynomial p = e == 0 ? cosinePolynomial() : phongPolynomial(e);
        for (int band = 0; band <= 5; ++band) {
            double truth = 0, polynomial = 0;
            constexpr int kSteps = 20000;
            for (int i = 0; i < kSteps; ++i) {
                const double t = -1 + (i + 0.5) * 2 / kSteps;
                const double legendre = std::legendre(static_cast<unsigned>(band), t);
                truth += exact(e, t) * legendre * 2 / kSteps;
                polynomial += zonalValue(p, static_cast<float>(t)) * legendre * 2 / kSteps;
            }
            EXPECT_NEAR(polynomial, band <= 4 ? truth : 0, 2e-5) << e << ' ' << band;
        }
    }
}

// Light of order 5 and the lobe's band 4 have degree 8 together: the nodes integrate their product
// exactly.
TEST(Transfer, NodalIrradianceIsExactUpToBandFour)
{
    RandomSphere random(5);
    for (int trial = 0; trial < 20; ++trial) {
        const vec3 n = random.direction(), d = random.direction();
        const Receiver receiver{vec3(0), n, random.direction(), 0, 0};
        const ShNodal nodal = transferNodal(shNodes(one()), receiver);
        // The light P_4(d . w): its irradiance is A_4 P_4(d . n), A_4 = -pi / 24.
        double sum = 0;
        for (int i = 0; i < 32; ++i)
            sum += static_cast<double>(kShNodes[i].w) * nodal.v[i] *
                   std::legendre(4u, static_cast<double>(dot(d, vec3(kShNodes[i]))));
        EXPECT_NEAR(sum * M_PI,
                    -M_PI / 24 *
                        std::legendre(4u, std::clamp(static_cast<double>(dot(d, n)), -1.0, 1.0)),
                    1e-5);
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
