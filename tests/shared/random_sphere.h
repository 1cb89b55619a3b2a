// Random functions and rotations for laws of spherical harmonics. Fixed seeds: the same numbers in
// every run.
#pragma once

#include "shaders/shared/sh.h"

#include <glm/gtc/quaternion.hpp>
#include <random>

namespace penumbra {

class RandomSphere {
public:
    explicit RandomSphere(unsigned seed) : m_engine(seed) {}

    float uniform(float low, float high)
    {
        // mt19937's output is the same everywhere; the standard's distributions are not.
        return low + (high - low) * static_cast<float>(m_engine() * (1.0 / 4294967296.0));
    }

    vec3 direction()
    {
        const float z = uniform(-1, 1), phi = uniform(0, 6.2831853f), s = std::sqrt(1 - z * z);
        return vec3(s * std::cos(phi), s * std::sin(phi), z);
    }

    // Coefficients in [-1, 1] in bands below `bands`, 0 above.
    Sh4 function(int bands = 4)
    {
        Sh4 f{};
        for (int i = 0; i < bands * bands; ++i)
            f.c[i] = uniform(-1, 1);
        return f;
    }

    mat3 rotation()
    {
        return glm::mat3_cast(
            normalize(quat(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1))));
    }

private:
    std::mt19937 m_engine;
};

// The function's value in a direction.
inline float evaluate(const Sh4& f, const vec3& d)
{
    return shDot(f, shBasis(d));
}

} // namespace penumbra
