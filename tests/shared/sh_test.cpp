#include "assets/sh_basis.h"
#include "shaders/shared/instance.h"

#include "tests/shared/random_sphere.h"

#include <gtest/gtest.h>

namespace penumbra {
namespace {

// Midpoint rule over z and azimuth, exact for what it integrates here up to rounding and 1/n^2.
template <class F>
double integrate(const F& f)
{
    constexpr int kRows = 400, kTurns = 32;
    double sum = 0;
    for (int i = 0; i < kRows; ++i) {
        for (int j = 0; j < kTurns; ++j) {
            const double z = -1 + (i + 0.5) * 2 / kRows, phi = (j + 0.5) * 2 * M_PI / kTurns,
                         s = std::sqrt(1 - z * z);
            sum += f(vec3(s * std::cos(phi), s * std::sin(phi), z)) * (2.0 / kRows) *
                   (2 * M_PI / kTurns);
        }
    }
    return sum;
}

TEST(Sh, BasisIsOrthonormal)
{
    for (int i = 0; i < 16; ++i)
        for (int j = 0; j <= i; ++j)
            EXPECT_NEAR(integrate([&](vec3 d) { return shBasis(d).c[i] * shBasis(d).c[j]; }),
                        i == j, 2e-4)
                << i << ' ' << j;
}

TEST(Sh, NodesAreADegreeNineRule)
{
    double weights = 0;
    for (const vec4& node : kShNodes) {
        weights += node.w;
        EXPECT_NEAR(length(vec3(node)), 1, 1e-6);
    }
    EXPECT_NEAR(weights, 4 * M_PI, 1e-5);
    // Products of three basis functions have degree 9: the rule's sums are the tripling
    // coefficients.
    for (int i = 0; i < 16; ++i) {
        Sh4 a{}, b{};
        a.c[i] = 1;
        b.c[15 - i] = 1;
        const Sh4 product = shProduct(a, b);
        for (int k = 0; k < 16; ++k) {
            double sum = 0;
            for (const vec4& node : kShNodes) {
                const Sh4 y = shBasis(vec3(node));
                sum += static_cast<double>(node.w) * y.c[i] * y.c[15 - i] * y.c[k];
            }
            EXPECT_NEAR(sum, product.c[k], 1e-6) << i << ' ' << k;
        }
    }
}

TEST(Sh, NodalValuesAreTheFunction)
{
    RandomSphere random(1);
    for (int trial = 0; trial < 20; ++trial) {
        const Sh4 f = random.function();
        const ShNodal nodal = shNodes(f);
        for (int n = 0; n < 32; ++n)
            EXPECT_NEAR(nodal.v[n], evaluate(f, vec3(kShNodes[n])), 2e-6);
    }
}

// Bands 0-1 times bands 0-1 end in band 2, so order 4 holds the product without truncation.
TEST(Sh, ProductOfLowBandsIsThePointwiseProduct)
{
    RandomSphere random(2);
    for (int trial = 0; trial < 200; ++trial) {
        const Sh4 f = random.function(2), g = random.function(2);
        const Sh4 product = shProduct(f, g);
        const vec3 d = random.direction();
        EXPECT_NEAR(evaluate(product, d), evaluate(f, d) * evaluate(g, d), 3e-6);
    }
}

// One product by nodes, projected back, is the triple product (findings section 1).
TEST(Sh, NodalProductEqualsTripleProduct)
{
    RandomSphere random(3);
    for (int trial = 0; trial < 50; ++trial) {
        const Sh4 f = random.function(), g = random.function(), product = shProduct(f, g);
        const ShNodal nodal = shMultiply(shNodes(f), shNodes(g));
        for (int k = 0; k < 16; ++k) {
            float sum = 0;
            for (int n = 0; n < 32; ++n)
                sum += kShNodes[n].w * nodal.v[n] * shBasis(vec3(kShNodes[n])).c[k];
            EXPECT_NEAR(sum, product.c[k], 5e-6);
        }
    }
}

TEST(Sh, ProductWithOneIsTheIdentity)
{
    RandomSphere random(4);
    Sh4 one{};
    one.c[0] = kSqrt4Pi;
    const Sh4 f = random.function(), same = shProduct(one, f);
    for (int i = 0; i < 16; ++i)
        EXPECT_NEAR(same.c[i], f.c[i], 1e-6);
}

// g = rotate(f): g(w) = f(R^-1 w), the whole range of rotations, those without a unique Euler angle
// too.
TEST(Sh, RotationMovesTheFunction)
{
    RandomSphere random(5);
    std::vector<mat3> rotations;
    for (int i = 0; i < 200; ++i)
        rotations.push_back(random.rotation());
    for (const vec3 axis : {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)})
        for (int quarter = 0; quarter < 4; ++quarter)
            rotations.push_back(
                glm::mat3_cast(glm::angleAxis(static_cast<float>(quarter * M_PI / 2), axis)));
    rotations.push_back(glm::mat3_cast(glm::angleAxis(3e-5f, vec3(1, 0, 0))));
    rotations.push_back(
        glm::mat3_cast(glm::angleAxis(static_cast<float>(M_PI) - 3e-5f, vec3(1, 0, 0))));
    // Half turns whose matrix rounds to cos = -0.99999988 with a sine of exactly 0.
    rotations.push_back(rotationMatrix(vec4(std::sqrt(0.5f), std::sqrt(0.5f), 0, 0)));
    rotations.push_back(rotationMatrix(vec4(std::sqrt(0.5f), -std::sqrt(0.5f), 0, 0)));
    for (const mat3& r : rotations) {
        const Sh4 f = random.function();
        const Sh4 g = shRotate(f, shRotation(r));
        for (int i = 0; i < 8; ++i) {
            const vec3 d = random.direction();
            EXPECT_NEAR(evaluate(g, d), evaluate(f, glm::transpose(r) * d), 2e-4);
        }
    }
}

TEST(Sh, OrderSixIsTheGeneralBasis)
{
    RandomSphere random(7);
    for (int trial = 0; trial < 100; ++trial) {
        const vec3 d = random.direction();
        std::array<double, 36> expected{};
        shBasisAnyOrder(6, glm::dvec3(d), expected);
        const Sh6 basis = shBasis6(d);
        for (std::size_t i = 0; i < expected.size(); ++i)
            EXPECT_NEAR(basis.c[i], expected[i], 3e-6) << i;
    }
}

TEST(Sh, RotateAndReturn)
{
    RandomSphere random(6);
    for (int trial = 0; trial < 100; ++trial) {
        const mat3 r = random.rotation();
        const Sh4 f = random.function();
        const Sh4 same = shRotate(shRotate(f, shRotation(r)), shRotation(glm::transpose(r)));
        for (int i = 0; i < 16; ++i)
            EXPECT_NEAR(same.c[i], f.c[i], 1e-5);
    }
}

} // namespace
} // namespace penumbra
