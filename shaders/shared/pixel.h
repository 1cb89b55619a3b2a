// Pixels as receivers: what the passes gbuffer, pixel_clusters, pixel_bounds and pixel_resolve
// agree on. Why so: docs/decisions/0010-pixel-receivers.md.
#ifndef PENUMBRA_SHADERS_SHARED_PIXEL_H
#define PENUMBRA_SHADERS_SHARED_PIXEL_H
#include "shaders/shared/interop.h"
PENUMBRA_BEGIN

PENUMBRA_CONST uint kPixelBlock = 32u;       // pixels, side of what one workgroup makes clusters of
PENUMBRA_CONST uint kPixelQuads = 256u;      // 2 x 2 pixels each, of a block: one per invocation
PENUMBRA_CONST uint kBackground = ~0u;       // in the place of an instance: the pixel shows none
PENUMBRA_CONST uint kNoSlot = ~0u;           // the pixel has no receiver of its own
PENUMBRA_CONST uint kPixelBoundsGroup = 16u; // clusters per workgroup: one per lane, as entity_sort

struct PixelPush {
    uint width, height; // of the picture
    uint capacity;      // clusters that the buffers hold
};

// Bits 0, 2, 4, 6 of i, packed.
PENUMBRA_FN uint evenBits(uint i)
{
    uint v = i & 0x55u;
    v = (v | (v >> 1u)) & 0x33u;
    return (v | (v >> 2u)) & 0x0fu;
}

// Place of quad `i` of a block, in quads: Morton order, so that 64 consecutive pixels of one
// instance lie close together.
PENUMBRA_FN uvec2 quadPlace(uint i)
{
    return uvec2(evenBits(i), evenBits(i >> 1u));
}

// How much the radiance of one point of an instance says of another's: 0 beyond a turn of the
// normal of 37 degrees, or where the line between the points leaves the surface by 30 degrees, as
// over a step in depth. Nearer points say more. All in one space, normals of unit length.
PENUMBRA_FN float pixelLikeness(vec3 a, vec3 normalA, vec3 b, vec3 normalB)
{
    const vec3 to = b - a, mean = normalA + normalB;
    const float apart = max(dot(to, to), 1e-20f);
    const float turn = max(0.0f, 5.0f * dot(normalA, normalB) - 4.0f);
    const float rise =
        abs(dot(mean, to)) * inversesqrt(max(apart * dot(mean, mean), 1e-30f)); // sine
    const float level = max(0.0f, 1.0f - 2.0f * rise);
    return turn * level / apart;
}

PENUMBRA_END
#endif
