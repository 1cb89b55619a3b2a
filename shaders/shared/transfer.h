// The receiver's side of a product: its self-visibility and its BRDF times cosine, the first factor
// T_p of Zhou et al. 2005 Fig. 5, and what the product gives against the light.
//   f(w) = (1 - g) max(0, n.w) / pi  +  g (e + 2) / (2 pi) max(0, r.w)^e max(0, n.w)
// n normal, r mirror direction of the view, g gloss fraction, e Phong exponent. Reflected radiance
// = albedo times the integral of L V f: the albedo tints both lobes (shaders/shared/surface.h). The
// same f is ray-traced in demo/reference.
#ifndef PENUMBRA_SHADERS_SHARED_TRANSFER_H
#define PENUMBRA_SHADERS_SHARED_TRANSFER_H
#include "shaders/shared/instance.h"
PENUMBRA_BEGIN

// A receiver in memory: two uvec4. Vertex shaders read the position as an attribute, stride 32,
// offset 0.
struct ReceiverTexels {
    uvec4 geometry; // bits of the position x, y, z (object space, metres), octahedral normal 2 x 16
                    // bits
    uvec4 selfVisibility; // 16 bytes, see assets/mesh_asset.h
};

struct Receiver {
    vec3 position; // world, metres
    vec3 normal;   // unit; world, or the frame of turnReceiver
    vec3 mirror;   // likewise: the view direction mirrored at the normal
    float glossFraction;
    float glossExponent;
};

PENUMBRA_FN uint packNormal(vec3 n)
{
    const vec2 uv = octahedralUv(n) * 65535.0f + vec2(0.5f);
    return uint(uv.x) | (uint(uv.y) << 16u);
}

PENUMBRA_FN vec3 unpackNormal(uint bits)
{
    return octahedralDirection(vec2(float(int(bits & 0xffffu)), float(int(bits >> 16u))) *
                               (1.0f / 65535.0f));
}

// `eye`: world.
PENUMBRA_FN Receiver makeReceiver(GpuInstance g, uvec4 geometry, vec3 eye)
{
    const vec3 local =
        vec3(uintBitsToFloat(geometry.x), uintBitsToFloat(geometry.y), uintBitsToFloat(geometry.z));
    Receiver r;
    r.position = affine(g.worldFromObject0, g.worldFromObject1, g.worldFromObject2, local);
    r.normal = linear(g.worldFromObject0, g.worldFromObject1, g.worldFromObject2,
                      unpackNormal(geometry.w)) *
               (1.0f / g.material1.y);
    r.mirror = reflect(normalize(r.position - eye), r.normal);
    r.glossFraction = g.material.w;
    r.glossExponent = g.material1.x;
    return r;
}

// The directions in another frame than the world's; the position stays.
PENUMBRA_FN Receiver turnReceiver(mat3 frameFromWorld, Receiver r)
{
    r.normal = frameFromWorld * r.normal;
    r.mirror = frameFromWorld * r.mirror;
    return r;
}

// Object space. `scale` is assets/mesh_asset.h's kSelfVisibilityScale.
PENUMBRA_FN Sh4 selfVisibility(uvec4 bytes, float scale)
{
    return fieldVisibility(fieldSteps(bytes), vec4(scale, scale, scale, scale));
}

// max(0, n.w): bands 0..2; band 3 of the clamped cosine is 0 (Ramamoorthi and Hanrahan 2001, eq.
// 8).
PENUMBRA_FN Sh4 cosineLobe(vec3 normal)
{
    return shZonal(normal, vec4(3.14159265f, 2.09439510f, 0.785398163f, 0.0f));
}

// (e + 2) / (2 pi) max(0, r.w)^e: zonal coefficients 2 pi times the integral of t^e P_l(t) over [0,
// 1], in closed form.
PENUMBRA_FN Sh4 phongLobe(vec3 mirror, float e)
{
    const float n = e + 2.0f;
    const vec4 scale =
        vec4(n / (e + 1.0f), 1.0f, 0.5f * n * (3.0f / (e + 3.0f) - 1.0f / (e + 1.0f)),
             0.5f * n * (5.0f / (e + 4.0f) - 3.0f / n));
    return shZonal(mirror, scale);
}

// A polynomial of degree 4 in the cosine to an axis: c.x + c.y t + c.z t^2 + c.w t^3 + quartic t^4.
struct ZonalPolynomial {
    vec4 c;
    float quartic;
};

// max(0, t) up to band 4: 1/4 P_0 + 1/2 P_1 + 5/16 P_2 - 3/32 P_4 (Ramamoorthi and Hanrahan 2001,
// eq. 19).
PENUMBRA_FN ZonalPolynomial cosinePolynomial()
{
    ZonalPolynomial p;
    p.c = vec4(0.05859375f, 0.5f, 0.8203125f, 0.0f);
    p.quartic = -0.41015625f;
    return p;
}

// (e + 2) / (2 pi) max(0, t)^e up to band 4: sum of (2l + 1) / 2 m_l P_l(t), m_l the integral of
// t^e P_l over [0, 1].
PENUMBRA_FN ZonalPolynomial phongPolynomial(float e)
{
    const float n = (e + 2.0f) * 0.159154943f;
    const float i0 = 1.0f / (e + 1.0f), i1 = 1.0f / (e + 2.0f), i2 = 1.0f / (e + 3.0f),
                i3 = 1.0f / (e + 4.0f),
                i4 = 1.0f / (e + 5.0f); // integrals of t^(e + k)
    const float m0 = 0.5f * n * i0;
    const float m1 = 1.5f * n * i1;
    const float m2 = 2.5f * n * 0.5f * (3.0f * i2 - i0);
    const float m3 = 3.5f * n * 0.5f * (5.0f * i3 - 3.0f * i1);
    const float m4 = 4.5f * n * 0.125f * (35.0f * i4 - 30.0f * i2 + 3.0f * i0);
    ZonalPolynomial p;
    p.c = vec4(m0 - 0.5f * m2 + 0.375f * m4, m1 - 1.5f * m3, 1.5f * m2 - 3.75f * m4, 2.5f * m3);
    p.quartic = 4.375f * m4;
    return p;
}

PENUMBRA_FN float zonalValue(ZonalPolynomial p, float t)
{
    return p.c.x + t * (p.c.y + t * (p.c.z + t * (p.c.w + t * p.quartic)));
}

// T in nodal form from the visibility, all occluders included: factors are multiplied node by node
// and never truncated, so their order does not matter. The lobes go up to band 4, one more than the
// fields: with light up to band 5 their product has degree 9, which the rule still integrates
// exactly, and the unshadowed radiance is right up to band 4 instead of 3.
PENUMBRA_FN ShNodal transferNodal(ShNodal visibility, Receiver receiver)
{
    ShNodal t = visibility;
    const float diffuse = (1.0f - receiver.glossFraction) * 0.318309886f;
    const ZonalPolynomial cosine = cosinePolynomial();
    const ZonalPolynomial phong = phongPolynomial(receiver.glossExponent);
    for (int i = 0; i < 32; ++i) {
        const vec3 node = vec3(kShNodes[i].x, kShNodes[i].y, kShNodes[i].z);
        float brdf = diffuse;
        if (receiver.glossFraction > 0.0f)
            brdf += receiver.glossFraction * zonalValue(phong, dot(receiver.mirror, node));
        t.v[i] *= brdf * zonalValue(cosine, dot(receiver.normal, node));
    }
    return t;
}

// T in SH, by triple products.
PENUMBRA_FN Sh4 transferSh(Sh4 visibility, Receiver receiver)
{
    const Sh4 cosine = cosineLobe(receiver.normal);
    Sh4 brdf;
    for (int i = 0; i < 16; ++i)
        brdf.c[i] = (1.0f - receiver.glossFraction) * 0.318309886f * cosine.c[i];
    if (receiver.glossFraction > 0.0f) {
        const Sh4 gloss = shProduct(phongLobe(receiver.mirror, receiver.glossExponent), cosine);
        for (int i = 0; i < 16; ++i)
            brdf.c[i] += receiver.glossFraction * gloss.c[i];
    }
    return shProduct(visibility, brdf);
}

PENUMBRA_END
#endif
