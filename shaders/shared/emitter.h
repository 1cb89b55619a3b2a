// What a local light gives a receiver, beyond the double product with its field.
//
// Order 4 holds a small light only roughly: its product with the cosine is 6 % too high overhead, a
// tenth of the light leaks to surfaces that it grazes, and some falls on those that look away. But
// band 1 of the field is the vector irradiance E = integral of L(w) w dw (Gershun, "The Light
// Field", J. Math. and Physics 18, 1939), and n.E is exactly what a
// matte surface gets of a light that stands wholly above its horizon. So what the product is good
// for is the part that arrives, and how much there is to arrive comes from E.
#ifndef PENUMBRA_SHADERS_SHARED_EMITTER_H
#define PENUMBRA_SHADERS_SHARED_EMITTER_H
#include "shaders/shared/transfer.h"
PENUMBRA_BEGIN

// Cosine-weighted share of a round light with the angular radius asin(s) whose centre is at the
// cosine t, over the same without a horizon: t above, 0 below, a parabola where the horizon cuts
// it, which meets both smoothly and is up to a sixth too high where the centre is on the horizon.
PENUMBRA_FN float risenCosine(float t, float s)
{
    const float up = clamp(t + s, 0.0f, 2.0f * s);
    return t >= s ? t : up * up / (4.0f * max(s, 1e-6f));
}

// Factor of a light's double product: unshadowed irradiance over what order 4 makes of it. 1 for
// lights that fill much of the hemisphere, which order 4 holds well. light: the field at the
// receiver, all channels added, in the frame of `normal`.
PENUMBRA_FN float irradianceCorrection(Sh4 light, vec3 normal)
{
    const vec3 vector = vec3(light.c[3], light.c[1], light.c[2]) * (1.0f / 0.488602512f);
    const float strength = length(vector);
    const float scalar = light.c[0] * kSqrt4Pi;
    const float product = shDot(light, cosineLobe(normal));
    if (strength <= 0.0f || scalar <= 0.0f)
        return 1.0f;
    // A disc of one radiance and angular radius a has strength / scalar = (1 + cos a) / 2.
    const float cosine = clamp(2.0f * strength / scalar - 1.0f, 0.0f, 1.0f);
    const float sine = sqrt(1.0f - cosine * cosine);
    const float exact = strength * risenCosine(dot(normal, vector) / strength, sine);
    const float ratio = clamp(exact / max(product, 1e-3f * strength), 0.0f, 2.0f);
    const float broad = clamp((sine - 0.6f) / 0.35f, 0.0f, 1.0f);
    return mix(ratio, 1.0f, broad * broad * (3.0f - 2.0f * broad));
}

PENUMBRA_END
#endif
