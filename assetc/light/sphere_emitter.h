// A sphere around the origin of one radiance: in closed form.
#pragma once

#include "assetc/light/emitter.h"

namespace penumbra {

class SphereEmitter final : public Emitter {
public:
    SphereEmitter(float radius, vec3 radiance) : m_radius(radius), m_radiance(radiance) {}

    [[nodiscard]] Sphere bounds() const override { return {vec3(0), m_radius}; }
    [[nodiscard]] RadianceSh radianceAt(vec3 position) const override; // inside: as on the surface
    [[nodiscard]] vec3 surfaceRadiance() const override { return m_radiance; }
    [[nodiscard]] vec3 power() const override;

private:
    float m_radius;  // metres
    vec3 m_radiance; // W/(m² sr)
};

} // namespace penumbra
