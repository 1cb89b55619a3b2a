// Real orthonormal spherical harmonics of any order, for tools that need more than the order 4 of
// shaders/shared/sh.h or doubles. Same conventions: index l(l+1)+m, no Condon-Shortley phase, polar
// axis z.
//     y_lm = K_lm P_lm(z) * { sqrt2 Re (x + iy)^m, m > 0;  1, m = 0;  sqrt2 Im (x + iy)^|m|, m < 0
//     }
// where P_lm is the associated Legendre function without its factor (1 - z^2)^(m/2), which (x +
// iy)^m carries. Source: Sloan, "Stupid Spherical Harmonics (SH) Tricks", GDC 2008, appendix A1:
// the recurrences in l and m.
#pragma once

#include "runtime/assert.h"
#include "shaders/shared/interop.h"

#include <cmath>
#include <numbers>
#include <span>

namespace penumbra {

// Writes the order^2 values of the basis at the unit `direction` to `out` [order^2].
inline void shBasisAnyOrder(int order, glm::dvec3 direction, std::span<double> out)
{
    PENUMBRA_ASSERT(order > 0 && out.size() == static_cast<std::size_t>(order) * order,
                    "{} values for order {}", out.size(), order);
    const double z = direction.z;
    double re = 1.0, im = 0.0;   // (x + iy)^m
    double diagonal = 1.0;       // P_mm = (2m - 1)!!
    double factorialRatio = 1.0; // (2m)! = (l + m)! / (l - m)! at l = m
    for (int m = 0; m < order; ++m) {
        double previous = 0.0, current = diagonal, ratio = factorialRatio;
        for (int l = m; l < order; ++l) {
            const double k = std::sqrt((2 * l + 1) / (4.0 * std::numbers::pi * ratio));
            if (m == 0) {
                out[l * (l + 1)] = k * current;
            } else {
                out[l * (l + 1) + m] = std::numbers::sqrt2 * k * current * re;
                out[l * (l + 1) - m] = std::numbers::sqrt2 * k * current * im;
            }
            const double next = ((2 * l + 1) * z * current - (l + m) * previous) / (l + 1 - m);
            previous = current;
            current = next;
            ratio *= static_cast<double>(l + 1 + m) / (l + 1 - m);
        }
        const double nextRe = direction.x * re - direction.y * im;
        im = direction.x * im + direction.y * re;
        re = nextRe;
        diagonal *= 2 * m + 1;
        factorialRatio *= (2.0 * m + 1) * (2.0 * m + 2);
    }
}

} // namespace penumbra
