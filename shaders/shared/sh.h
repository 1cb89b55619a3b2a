// Real orthonormal spherical harmonics of order 4: bands 0..3, 16 coefficients, index l(l+1)+m, no
// Condon-Shortley phase. Axes as everywhere in the project: x, y, z of the space at hand, polar
// axis z.
//   Sh4       coefficients of a function on the sphere
//   Sh6       the same of order 6: bands 0..5, 36 coefficients
//   ShNodal   its values at the 32 nodes kShNodes of a quadrature rule of degree 9. The rule
//   integrates products of three
//             order-4 functions exactly, so a product of two in nodal form, projected back, equals
//             the triple product; longer chains keep more than order 4, which is closer to the
//             truth (findings section 1).
#ifndef PENUMBRA_SHADERS_SHARED_SH_H
#define PENUMBRA_SHADERS_SHARED_SH_H
#include "shaders/shared/interop.h"
PENUMBRA_BEGIN

PENUMBRA_CONST float kSqrt4Pi = 3.5449077018110318f; // coefficient 0 of the function 1

struct Sh4 {
    float c[16];
};

struct ShNodal {
    float v[32];
};

// cos(m a) and sin(m a) of one Euler angle a, m = 1..3.
struct ShTurn {
    vec3 c;
    vec3 s;
};

// A rotation R = Rz(alpha) Ry(beta) Rz(gamma): 18 numbers that follow from 6, which cost less to
// load than the 84 of a dense matrix.
struct ShRotation {
    ShTurn gamma;
    ShTurn beta;
    ShTurn alpha;
};

#include "shaders/generated/sh_nodes.h"
#include "shaders/generated/sh_product.h"
#include "shaders/generated/sh_rotation.h"

PENUMBRA_FN Sh4 shBasis(vec3 d)
{
    const float x = d.x, y = d.y, z = d.z;
    Sh4 b;
    b.c[0] = 0.282094792f;
    b.c[1] = 0.488602512f * y;
    b.c[2] = 0.488602512f * z;
    b.c[3] = 0.488602512f * x;
    b.c[4] = 1.09254843f * x * y;
    b.c[5] = 1.09254843f * y * z;
    b.c[6] = 0.946174696f * z * z - 0.315391565f;
    b.c[7] = 1.09254843f * x * z;
    b.c[8] = 0.546274215f * (x * x - y * y);
    b.c[9] = 0.59004359f * y * (3.0f * x * x - y * y);
    b.c[10] = 2.89061144f * x * y * z;
    b.c[11] = 0.457045799f * y * (5.0f * z * z - 1.0f);
    b.c[12] = 0.373176333f * z * (5.0f * z * z - 3.0f);
    b.c[13] = 0.457045799f * x * (5.0f * z * z - 1.0f);
    b.c[14] = 1.44530572f * z * (x * x - y * y);
    b.c[15] = 0.59004359f * x * (x * x - 3.0f * y * y);
    return b;
}

struct Sh6 {
    float c[36];
};

// Order 6, for light: kernel exact takes two bands more of it than fields have. The polynomials are
// those of Sloan, "Stupid Spherical Harmonics (SH) Tricks" (GDC 2008), "Polynomial
// Forms of SH Basis".
PENUMBRA_FN Sh6 shBasis6(vec3 d)
{
    const float x = d.x, y = d.y, z = d.z;
    const float z2 = z * z;
    const float c2 = x * x - y * y, s2 = 2.0f * x * y; // (x + i y)^m
    const float c3 = c2 * x - s2 * y, s3 = s2 * x + c2 * y;
    const float c4 = c3 * x - s3 * y, s4 = s3 * x + c3 * y;
    const float c5 = c4 * x - s4 * y, s5 = s4 * x + c4 * y;
    const Sh4 low = shBasis(d);
    Sh6 b;
    for (int i = 0; i < 16; ++i)
        b.c[i] = low.c[i];
    b.c[16] = 0.625835735f * s4;
    b.c[17] = 1.77013077f * z * s3;
    b.c[18] = 0.473087348f * (7.0f * z2 - 1.0f) * s2;
    b.c[19] = 0.669046544f * z * (7.0f * z2 - 3.0f) * y;
    b.c[20] = 0.105785547f * ((35.0f * z2 - 30.0f) * z2 + 3.0f);
    b.c[21] = 0.669046544f * z * (7.0f * z2 - 3.0f) * x;
    b.c[22] = 0.473087348f * (7.0f * z2 - 1.0f) * c2;
    b.c[23] = 1.77013077f * z * c3;
    b.c[24] = 0.625835735f * c4;
    b.c[25] = 0.656382057f * s5;
    b.c[26] = 2.07566231f * z * s4;
    b.c[27] = 0.489238299f * (9.0f * z2 - 1.0f) * s3;
    b.c[28] = 2.39676839f * z * (3.0f * z2 - 1.0f) * s2;
    b.c[29] = 0.452946651f * ((21.0f * z2 - 14.0f) * z2 + 1.0f) * y;
    b.c[30] = 0.116950322f * z * ((63.0f * z2 - 70.0f) * z2 + 15.0f);
    b.c[31] = 0.452946651f * ((21.0f * z2 - 14.0f) * z2 + 1.0f) * x;
    b.c[32] = 2.39676839f * z * (3.0f * z2 - 1.0f) * c2;
    b.c[33] = 0.489238299f * (9.0f * z2 - 1.0f) * c3;
    b.c[34] = 2.07566231f * z * c4;
    b.c[35] = 0.656382057f * c5;
    return b;
}

// A function that is symmetric about `axis`: scale[l] are its zonal coefficients over the basis
// value, that is, the function is sum_l scale[l] sum_m Y_lm(axis) Y_lm(w).
PENUMBRA_FN Sh4 shZonal(vec3 axis, vec4 scale)
{
    Sh4 b = shBasis(axis);
    b.c[0] *= scale.x;
    for (int i = 1; i < 4; ++i)
        b.c[i] *= scale.y;
    for (int i = 4; i < 9; ++i)
        b.c[i] *= scale.z;
    for (int i = 9; i < 16; ++i)
        b.c[i] *= scale.w;
    return b;
}

// Double product: the integral of a b over the sphere.
PENUMBRA_FN float shDot(Sh4 a, Sh4 b)
{
    float sum = 0.0f;
    for (int i = 0; i < 16; ++i)
        sum += a.c[i] * b.c[i];
    return sum;
}

PENUMBRA_FN Sh4 shAdd(Sh4 a, Sh4 b)
{
    for (int i = 0; i < 16; ++i)
        a.c[i] += b.c[i];
    return a;
}

PENUMBRA_FN ShNodal shMultiply(ShNodal a, ShNodal b)
{
    ShNodal p;
    for (int i = 0; i < 32; ++i)
        p.v[i] = a.v[i] * b.v[i];
    return p;
}

PENUMBRA_FN ShTurn shTurn(float cosine, float sine)
{
    const float c2 = cosine * cosine - sine * sine, s2 = 2.0f * sine * cosine;
    ShTurn turn;
    turn.c = vec3(cosine, c2, c2 * cosine - s2 * sine);
    turn.s = vec3(sine, s2, s2 * cosine + c2 * sine);
    return turn;
}

// Euler constants of a rotation matrix (columns are the images of x, y, z), from
// Rz(-alpha) R = Ry(beta) Rz(gamma): its column z is (sin beta, 0, cos beta), its row y is
// (sin gamma, cos gamma, 0). So near the poles, where z says little of alpha, any alpha will do.
PENUMBRA_FN ShRotation shRotation(mat3 r)
{
    const float sin2 = r[2][0] * r[2][0] + r[2][1] * r[2][1];
    const float scale = sin2 > 1e-30f ? inversesqrt(sin2) : 0.0f;
    const float cosAlpha = sin2 > 1e-30f ? r[2][0] * scale : 1.0f, sinAlpha = r[2][1] * scale;
    ShRotation rotation;
    rotation.alpha = shTurn(cosAlpha, sinAlpha);
    rotation.beta = shTurn(r[2][2], cosAlpha * r[2][0] + sinAlpha * r[2][1]);
    rotation.gamma =
        shTurn(cosAlpha * r[1][1] - sinAlpha * r[1][0], cosAlpha * r[0][1] - sinAlpha * r[0][0]);
    return rotation;
}

PENUMBRA_FN Sh4 shRotateZ(Sh4 f, ShTurn t)
{
    Sh4 g;
    g.c[0] = f.c[0];
    g.c[1] = t.s.x * f.c[3] + t.c.x * f.c[1];
    g.c[2] = f.c[2];
    g.c[3] = t.c.x * f.c[3] - t.s.x * f.c[1];
    g.c[4] = t.s.y * f.c[8] + t.c.y * f.c[4];
    g.c[5] = t.s.x * f.c[7] + t.c.x * f.c[5];
    g.c[6] = f.c[6];
    g.c[7] = t.c.x * f.c[7] - t.s.x * f.c[5];
    g.c[8] = t.c.y * f.c[8] - t.s.y * f.c[4];
    g.c[9] = t.s.z * f.c[15] + t.c.z * f.c[9];
    g.c[10] = t.s.y * f.c[14] + t.c.y * f.c[10];
    g.c[11] = t.s.x * f.c[13] + t.c.x * f.c[11];
    g.c[12] = f.c[12];
    g.c[13] = t.c.x * f.c[13] - t.s.x * f.c[11];
    g.c[14] = t.c.y * f.c[14] - t.s.y * f.c[10];
    g.c[15] = t.c.z * f.c[15] - t.s.z * f.c[9];
    return g;
}

// g(w) = f(R^-1 w): 104 multiplications and 52 additions. Kautz et al. 2002, as Tamura et al. 2006
// section 5.2 use it.
PENUMBRA_FN Sh4 shRotate(Sh4 f, ShRotation r)
{
    return shRotateZ(shRotateX270(shRotateZ(shRotateX90(shRotateZ(f, r.gamma)), r.beta)), r.alpha);
}

PENUMBRA_FN ShTurn shInverse(ShTurn turn)
{
    turn.s = -turn.s;
    return turn;
}

PENUMBRA_FN ShRotation shInverse(ShRotation r)
{
    ShRotation inverse;
    inverse.gamma = shInverse(r.alpha);
    inverse.beta = shInverse(r.beta);
    inverse.alpha = shInverse(r.gamma);
    return inverse;
}

PENUMBRA_END
#endif
