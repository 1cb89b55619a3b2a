// A light that every point sees as a round disc of one radiance: a cap of the sky, or a sphere. Its
// shadow rays are what the fields are compared with (demo/sweep), so they are done well. The
// irradiance without occluders is known in closed form, and the rays only say which part arrives:
//     E = E0 * sum(c V) / sum(c),    c = n.w, V = 1 where no triangle lies in the way
// (a ratio estimator: Heitz, Hill and McGuire, "Combining Analytic Direct Illumination and
// Stochastic Shadows", 2018), so that receivers in full light have no noise. Rays are spread evenly
// over the solid angle of the disc, or as the cosine where the disc fills most of the hemisphere.
#pragma once

#include "demo/reference/reference.h"

namespace penumbra {

// The disc as a point sees it.
struct RoundView {
    vec3 axis{0, 1, 0}; // unit, to the disc's middle
    float sine = 1;     // of its half-angle, in (0, 1]
};

class RoundLight {
public:
    // A cap of the sky about the unit `axis`, half-angle up to 90 degrees. What of it lies below
    // the horizon y = 0 gives no light, as in aboveGround of systems/frame_constants.h.
    static RoundLight cap(vec3 axis, float sineOfHalfAngle, float radiance);
    // A sphere, world, metres; receivers lie outside it.
    static RoundLight sphere(vec3 center, float radius, float radiance);

    [[nodiscard]] RoundView seenFrom(vec3 point) const;
    [[nodiscard]] float radiance() const { return m_radiance; } // W/(m² sr)
    [[nodiscard]] bool isSphere() const { return m_radius > 0; }
    // From `point` along the unit `direction` to the surface of the sphere; infinite for a cap.
    [[nodiscard]] float distance(vec3 point, vec3 direction) const;

private:
    vec3 m_place{0, 1, 0}; // axis of a cap, centre of a sphere
    float m_sine = 1, m_radius = 0, m_radiance = 1;
};

// Irradiance of a disc of radiance 1 on a surface with the unit `normal`, cut by the surface's
// horizon. Closed form: Lagarde and de Rousiers, "Moving Frostbite to PBR", SIGGRAPH 2014 course,
// listing 7, after Snyder, "Area Light Sources for Real-Time Graphics", 1996.
float roundIrradiance(const RoundView& view, vec3 normal);

// What matte receivers reflect, by options.samples rays per receiver (rounded up to a power of
// two). Materials' gloss is left out. Runs in the caller's TBB arena.
ReferenceRadiance shadeRound(const ReferenceScene& scene, const RoundLight& light,
                             std::span<const ReferenceReceiver> receivers,
                             const ReferenceOptions& options);

} // namespace penumbra
