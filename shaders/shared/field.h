// Where a point falls in a shadow field, and the field's value there. Geometry and quantisation:
// assets/shadow_field.h.
//   trilinear    8 samples, float weights: Zhou et al. 2005 section 3.3, used by kernel `literal`
//   tetrahedral  4 samples, integer weights of 1/256, used by kernel `exact` (findings section 1)
// The entry point fetches the samples; a sample is one uvec4 of 16 unsigned bytes, coefficient 0 in
// the lowest.
#ifndef PENUMBRA_SHADERS_SHARED_FIELD_H
#define PENUMBRA_SHADERS_SHARED_FIELD_H
#include "shaders/shared/sh.h"
PENUMBRA_BEGIN

// Grid of a field with one side on all shells, as the GPU holds it: samples [channel][y][x][shell],
// so that a cell's nodes on neighbouring shells share a cache line (docs/decisions/0005).
struct FieldGrid {
    uint firstSample;
    uint side;        // nodes per edge of the octahedral map
    float shellScale; // shell coordinate = shellScale * log2(radius) + shellBias, radius in
                      // bounding radii
    float shellBias;
    float lastShell; // shell count - 1
    uint shells;
};

// A point in the grid: sample index of the lower node of the cell and fractions along u, v and
// shell, in [0, 1] but for rounding, which the weights below round away.
struct FieldCell {
    uint sample0;
    vec3 fraction;
    float decay; // g(r), faded to 0 over the last interval of shells, where the field ends without
                 // a step
};

// Octahedral map of a direction (any length but 0) to [0, 1]^2.
PENUMBRA_FN vec2 octahedralUv(vec3 d)
{
    const float scale =
        1.0f / max(abs(d.x) + abs(d.y) + abs(d.z), 1e-20f); // the centre has a uv too
    vec2 p = vec2(d.x * scale, d.y * scale);
    if (d.z < 0.0f)
        p = vec2((1.0f - abs(p.y)) * (p.x >= 0.0f ? 1.0f : -1.0f),
                 (1.0f - abs(p.x)) * (p.y >= 0.0f ? 1.0f : -1.0f));
    return p * 0.5f + vec2(0.5f);
}

PENUMBRA_FN vec3 octahedralDirection(vec2 uv)
{
    const vec2 p = uv * 2.0f - vec2(1.0f);
    vec3 d = vec3(p.x, p.y, 1.0f - abs(p.x) - abs(p.y));
    if (d.z < 0.0f)
        d = vec3((1.0f - abs(p.y)) * (p.x >= 0.0f ? 1.0f : -1.0f),
                 (1.0f - abs(p.x)) * (p.y >= 0.0f ? 1.0f : -1.0f), d.z);
    return normalize(d);
}

// g(r): how the deviation from "unoccluded" shrinks with the distance, r2 = squared radius in
// bounding radii. Far away the blocked solid angle goes with 1 / r^2; the constant keeps the centre
// finite.
PENUMBRA_FN float fieldDecay(float r2)
{
    return 1.0f / (0.25f + r2);
}

// p: the point relative to the field's centre, field axes, unit: bounding radii.
PENUMBRA_FN FieldCell fieldCell(vec3 p, FieldGrid grid)
{
    const float r2 = max(dot(p, p), 1e-12f);
    const float shell = 0.5f * log2(r2) * grid.shellScale + grid.shellBias;
    const float inside = clamp(shell, 0.0f, grid.lastShell);
    // Through int: lavapipe converts float to uint much slower, and rounds towards 0 for free.
    const vec2 at = octahedralUv(p) * float(int(grid.side) - 1);
    const int x = min(int(at.x), int(grid.side) - 2), y = min(int(at.y), int(grid.side) - 2);
    const int s = min(int(inside), int(grid.shells) - 2);

    FieldCell cell;
    cell.sample0 = grid.firstSample + (uint(y) * grid.side + uint(x)) * grid.shells + uint(s);
    cell.fraction = vec3(at.x - float(x), at.y - float(y), inside - float(s));
    cell.decay = fieldDecay(r2) * clamp(grid.lastShell - shell, 0.0f, 1.0f);
    return cell;
}

// The tetrahedron of the cell that holds the point: its 4 corners, as steps from sample0, and
// weights that sum to 256.
struct FieldTetrahedron {
    uvec4 offset;
    uvec4 weight;
};

PENUMBRA_FN FieldTetrahedron fieldTetrahedron(vec3 f, FieldGrid grid)
{
    const uint stepX = grid.shells, stepY = grid.side * grid.shells;
    const float high = max(max(f.x, f.y), f.z), low = min(min(f.x, f.y), f.z);
    const float middle = f.x + f.y + f.z - high - low;
    const bool xy = f.x >= f.y, yz = f.y >= f.z, xz = f.x >= f.z;
    const uint steepest = xy && xz ? stepX : (yz && !xy ? stepY : 1u);
    const uint flattest = yz && xz ? 1u : (xy ? stepY : stepX);
    const uint all = stepX + stepY + 1u;
    const uint w1 = uint(int(high * 256.0f + 0.5f));
    const uint w2 = uint(int(middle * 256.0f + 0.5f));
    const uint w3 = uint(int(low * 256.0f + 0.5f));
    FieldTetrahedron t;
    t.offset = uvec4(0u, steepest, all - flattest, all);
    t.weight = uvec4(256u - w1, w1 - w2, w2 - w3, w3);
    return t;
}

// Weighted sum of the 4 corners, all 16 bytes at once: two bytes of 16 bits each in one 32-bit
// word, since 255 * 256 < 2^16. Returns (sum - 128 * 256) per coefficient, that is, 256 times the
// deviation in quantisation steps.
PENUMBRA_FN Sh4 fieldBlend(uvec4 s0, uvec4 s1, uvec4 s2, uvec4 s3, uvec4 weight)
{
    const uvec4 mask = uvec4(0x00ff00ffu);
    const uvec4 even = (s0 & mask) * weight.x + (s1 & mask) * weight.y + (s2 & mask) * weight.z +
                       (s3 & mask) * weight.w;
    const uvec4 odd = ((s0 >> 8u) & mask) * weight.x + ((s1 >> 8u) & mask) * weight.y +
                      ((s2 >> 8u) & mask) * weight.z + ((s3 >> 8u) & mask) * weight.w;
    Sh4 f;
    for (int k = 0; k < 4; ++k) {
        f.c[4 * k] = float(int(even[k] & 0xffffu) - 32768);
        f.c[4 * k + 1] = float(int(odd[k] & 0xffffu) - 32768);
        f.c[4 * k + 2] = float(int(even[k] >> 16u) - 32768);
        f.c[4 * k + 3] = float(int(odd[k] >> 16u) - 32768);
    }
    return f;
}

// Steps -> coefficients. scale[l] = K_l * decay / 256, or K_l * decay for the trilinear sum.
PENUMBRA_FN Sh4 fieldDeviation(Sh4 f, vec4 scale)
{
    f.c[0] *= scale.x;
    for (int i = 1; i < 4; ++i)
        f.c[i] *= scale.y;
    for (int i = 4; i < 9; ++i)
        f.c[i] *= scale.z;
    for (int i = 9; i < 16; ++i)
        f.c[i] *= scale.w;
    return f;
}

// The same, from "nothing in the way".
PENUMBRA_FN Sh4 fieldVisibility(Sh4 f, vec4 scale)
{
    Sh4 visibility = fieldDeviation(f, scale);
    visibility.c[0] += kSqrt4Pi;
    return visibility;
}

// Coefficients of one sample as deviation in steps, q - 128.
PENUMBRA_FN Sh4 fieldSteps(uvec4 s)
{
    Sh4 f;
    for (int k = 0; k < 4; ++k)
        for (int b = 0; b < 4; ++b)
            f.c[4 * k + b] = float(int((s[k] >> uint(8 * b)) & 255u) - 128);
    return f;
}

// Corner i of the cell (bit 0: u, bit 1: v, bit 2: shell) and its trilinear weight.
PENUMBRA_FN uint fieldCornerOffset(uint corner, FieldGrid grid)
{
    return ((corner & 1u) + ((corner >> 1u) & 1u) * grid.side) * grid.shells + (corner >> 2u);
}

PENUMBRA_FN float fieldCornerWeight(uint corner, vec3 f)
{
    return ((corner & 1u) != 0u ? f.x : 1.0f - f.x) * ((corner & 2u) != 0u ? f.y : 1.0f - f.y) *
           ((corner & 4u) != 0u ? f.z : 1.0f - f.z);
}

PENUMBRA_END
#endif
