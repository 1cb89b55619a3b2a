#include "shaders/shared/emitter.h"

#include <gtest/gtest.h>

namespace penumbra {
namespace {

// Order-4 SH of a disc of radiance 1 about the pole `axis`, angular radius a: zonal coefficients by
// integration of the Legendre polynomials.
Sh4 discLight(vec3 axis, double a)
{
    const double c = std::cos(a);
    const double zonal[4] = {2 * M_PI * (1 - c), M_PI * (1 - c * c), M_PI * (c - c * c * c),
                             M_PI / 4 * (-5 * c * c * c * c + 6 * c * c - 1)};
    const Sh4 y = shBasis(axis);
    Sh4 light{};
    for (int l = 0; l < 4; ++l)
        for (int k = l * l; k < (l + 1) * (l + 1); ++k)
            light.c[k] = static_cast<float>(zonal[l]) * y.c[k];
    return light;
}

// Irradiance of the disc on a surface whose normal makes the angle `elevation` with the axis.
double discIrradiance(double a, double angle)
{
    double sum = 0;
    constexpr int kSteps = 150;
    for (int i = 0; i < kSteps; ++i)
        for (int j = 0; j < kSteps; ++j) {
            const double cosine = 1 - (1 - std::cos(a)) * (i + 0.5) / kSteps;
            const double phi = 2 * M_PI * (j + 0.5) / kSteps, sine = std::sqrt(1 - cosine * cosine);
            sum += std::max(0.0, cosine * std::cos(angle) + sine * std::cos(phi) * std::sin(angle));
        }
    return sum / (kSteps * kSteps) * 2 * M_PI * (1 - std::cos(a));
}

vec3 normalAt(double angle)
{
    return {static_cast<float>(std::sin(angle)), 0, static_cast<float>(std::cos(angle))};
}

double corrected(const Sh4& light, vec3 normal)
{
    return static_cast<double>(irradianceCorrection(light, normal)) *
           static_cast<double>(shDot(light, cosineLobe(normal)));
}

// The corrected product against the integral, as a part of the irradiance straight below the light:
// exact where the light stands clear of the horizon, by the parabola's sixth where it is cut.
TEST(Emitter, CorrectedProductIsTheIrradianceOfADisc)
{
    for (const double degrees : {1.0, 5.0, 10.0, 20.0, 30.0}) {
        const double a = degrees * M_PI / 180;
        const Sh4 light = discLight({0, 0, 1}, a);
        const double top = discIrradiance(a, 0);
        for (double angle = 0; angle < 3.1; angle += 0.05) {
            const double expected = discIrradiance(a, angle);
            const bool clear = angle < M_PI / 2 - a || angle > M_PI / 2 + a;
            EXPECT_NEAR(corrected(light, normalAt(angle)), expected,
                        (clear ? 0.005 : 0.05 * std::sin(a) + 0.002) * top)
                << degrees << " degrees, normal at " << angle;
        }
    }
}

// What it is for: uncorrected, a small light reaches surfaces that look away from it.
TEST(Emitter, UncorrectedProductLeaks)
{
    const Sh4 light = discLight({0, 0, 1}, 0.1);
    const double top = discIrradiance(0.1, 0);
    const vec3 away = normalAt(1.68);
    EXPECT_GT(std::abs(shDot(light, cosineLobe(away))), 0.02 * top);
    EXPECT_NEAR(corrected(light, away), 0, 1e-4 * top);
}

TEST(Emitter, BroadLightsKeepTheProduct)
{
    EXPECT_EQ(irradianceCorrection(discLight({0, 0, 1}, 1.4), normalAt(0.7)), 1);
    Sh4 sky{};
    sky.c[0] = kSqrt4Pi;
    EXPECT_EQ(irradianceCorrection(sky, normalAt(0.3)), 1); // no direction at all
    EXPECT_EQ(irradianceCorrection(Sh4{}, normalAt(0.3)), 1);
}

TEST(Emitter, ChangesSmoothlyWithTheNormalAndTheSize)
{
    const double top = discIrradiance(0.2, 0);
    double last = -1;
    for (double angle = 0; angle < 3.1; angle += 0.002) {
        const double now = corrected(discLight({0, 0, 1}, 0.2), normalAt(angle));
        if (last >= 0) {
            EXPECT_LT(std::abs(now - last), 0.004 * top) << angle;
        }
        last = now;
    }
    last = -1;
    for (double a = 0.3; a < 1.5; a += 0.001) { // through the blend at sines of .6 to .95
        const double now =
            static_cast<double>(irradianceCorrection(discLight({0, 0, 1}, a), normalAt(0.5)));
        if (last >= 0) {
            EXPECT_LT(std::abs(now - last), 0.01) << a;
        }
        last = now;
    }
}

} // namespace
} // namespace penumbra
