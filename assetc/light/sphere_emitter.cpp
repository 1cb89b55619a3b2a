#include "assetc/light/sphere_emitter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace penumbra {

// The sphere covers a cap of half-angle a, sin a = radius / distance. With c = cos a and s = sin a
// the zonal integrals 2 pi int_c^1 P_l(z) dz of bands 0..3, without the cancellation of 1 - c:
//     2 pi (s^2 / (1 + c),  s^2 / 2,  c s^2 / 2,  s^2 (5 c^2 - 1) / 8)
RadianceSh SphereEmitter::radianceAt(vec3 position) const
{
    const double distance = std::max<double>(glm::length(glm::dvec3(position)), m_radius);
    const double sine = m_radius / distance, s2 = sine * sine; // at most 1
    const double c = std::sqrt(1 - s2);
    const double twoPi = 2 * std::numbers::pi;
    const vec4 zonal(twoPi * s2 / (1 + c), twoPi * s2 / 2, twoPi * c * s2 / 2,
                     twoPi * s2 * (5 * c * c - 1) / 8);
    RadianceSh sh;
    for (int channel = 0; channel < 3; ++channel)
        sh[static_cast<std::size_t>(channel)] =
            shZonal(-normalize(position), zonal * m_radiance[channel]);
    return sh;
}

vec3 SphereEmitter::power() const
{
    constexpr auto kPi = static_cast<float>(std::numbers::pi);
    return m_radiance * kPi * (4 * kPi * m_radius * m_radius);
}

} // namespace penumbra
