// Rectangles, discs and spots: a flat surface in the plane z = 0 around the origin that emits along
// +z.
#pragma once

#include "assetc/light/emitter.h"
#include "assetc/light/picture.h"
#include "assetc/light/spec.h"

#include <optional>
#include <vector>

namespace penumbra {

// Cone of a spot as in KHR_lights_punctual: the intensity at the angle a from the axis is
//     I(a) = I_0 clamp((cos a - cos outer) / (cos inner - cos outer), 0, 1)^2.
struct SpotCone {
    double cosInner = 1, cosOuter = 0;

    [[nodiscard]] double falloff(double cosine) const;
    // Integral of falloff over all directions, sr.
    [[nodiscard]] double solidAngle() const;
};

// Mean radiance of the surface in cells of powers of two: level k has 2^k x 2^k of them, over the
// unit square that FlatEmitter maps to the surface with equal areas.
using RadiancePyramid = std::vector<std::vector<vec3>>;

class FlatEmitter final : public Emitter {
public:
    // `spec` is a rectangle, disc or spot; `picture`, where given, multiplies the emission. Error:
    // a power that a black channel of the picture cannot give, or more than kMaxRadiance.
    static Result<FlatEmitter> make(const LightSpec& spec, const LightPicture* picture);

    [[nodiscard]] Sphere bounds() const override;
    [[nodiscard]] RadianceSh radianceAt(vec3 position) const override;
    [[nodiscard]] vec3 surfaceRadiance() const override { return m_scale; }
    [[nodiscard]] vec3 power() const override;

private:
    struct Sum;

    [[nodiscard]] glm::dvec2 place(glm::dvec2 uv) const; // unit square -> surface, metres
    [[nodiscard]] double area() const;
    void paint(const LightPicture& picture);
    [[nodiscard]] vec3 cell(int level, std::uint32_t x, std::uint32_t y) const;
    void integrate(int level, std::uint32_t x, std::uint32_t y, Sum& sum) const;
    void addPoint(glm::dvec2 at, double area, vec3 radiance, Sum& sum) const;

    bool m_round = false;
    bool m_twoSided = false;
    glm::dvec2 m_half{0};      // half size, or the radius twice
    vec3 m_scale{0};           // radiance of a white pixel; of a spot, along its axis
    RadiancePyramid m_pyramid; // the picture; one cell of 1 without
    std::optional<SpotCone> m_cone;
};

} // namespace penumbra
