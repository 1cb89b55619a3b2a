// A surface that emits, as the field baker sees it.
#pragma once

#include "assets/bounding_sphere.h"
#include "shaders/shared/sh.h"

#include <array>

namespace penumbra {

using RadianceSh = std::array<Sh4, 3>; // RGB, W/(m² sr)

class Emitter {
public:
    virtual ~Emitter() = default;

    // Holds the whole surface; its centre and radius become the field's. Object space, metres.
    [[nodiscard]] virtual Sphere bounds() const = 0;

    // Radiance that arrives at `position` from each direction, w pointing at the emitter:
    //     c_i = integral L(w) y_i(w) dw = integral over the surface L y_i(w) cos / d^2 dA.
    // Thread safe and deterministic.
    [[nodiscard]] virtual RadianceSh radianceAt(vec3 position) const = 0;

    // radianceAt, and an estimate of its error by the finite number of samples: half the difference
    // between what every other sample gives. 0 where there is no such error.
    struct Estimate {
        RadianceSh radiance, noise;
    };
    [[nodiscard]] virtual Estimate estimateAt(vec3 position) const
    {
        return {radianceAt(position), {}};
    }

    // Of the surface, where its picture is white; of a spot, along its axis. RGB, W/(m² sr).
    [[nodiscard]] virtual vec3 surfaceRadiance() const = 0;

    // Flux through the whole surface without what it blocks itself, RGB, W.
    [[nodiscard]] virtual vec3 power() const = 0;

protected:
    Emitter() = default;
    Emitter(const Emitter&) = default;
    Emitter& operator=(const Emitter&) = default;
};

} // namespace penumbra
