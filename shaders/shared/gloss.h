// Sharp reflections of the sky. The SH of the light end at band 5, those of a Phong lobe at band 4:
// from exponent 8 on their product rings, a bright sky leaves dark spots on a ball. Sharp lobes
// take their light from maps of the sky that were filtered by whole lobes, one per power of two of
// the exponent:
//     integral of L V f  ->  P A
// L the sky's radiance, V the visibility, f the Phong lobe times cosine (transfer.h, without g and
// the diffuse part), P the filtered sky where f is largest, A the integral of V f with the same
// band-limited f as everywhere: what SH can say of an occluder in the way of the lobe. This is the
// split of radiance and visibility of Karis ("Real shading in Unreal Engine 4", SIGGRAPH course
// 2013).
#ifndef PENUMBRA_SHADERS_SHARED_GLOSS_H
#define PENUMBRA_SHADERS_SHARED_GLOSS_H
#include "shaders/shared/transfer.h"
PENUMBRA_BEGIN

// The filtered sky: octahedral maps [side][side] with nodes on the edges, world axes, one after the
// other; level k for the exponent 4 2^k. Sides: what a lobe leaves of a sun's edge is to span a few
// cells (docs/decisions/0013).
PENUMBRA_CONST uint kSkyLobeLevels = 9u;
PENUMBRA_CONST uint kSkyLobeTexels = 124937u;

PENUMBRA_FN uint skyLobeSide(uint level)
{
    return level < 2u ? 65u : 129u;
}

PENUMBRA_FN uint skyLobeFirst(uint level)
{
    uint first = 0u;
    for (uint k = 0u; k < level; ++k)
        first += skyLobeSide(k) * skyLobeSide(k);
    return first;
}

// The four nodes around a direction: texel, + 1, + side, + side + 1.
struct SkyLobeCell {
    uint texel;
    uint side;
    vec2 fraction;
};

PENUMBRA_FN SkyLobeCell skyLobeCell(vec3 direction, uint level)
{
    SkyLobeCell cell;
    cell.side = skyLobeSide(level);
    const vec2 at = octahedralUv(direction) * float(cell.side - 1u);
    const uint x = min(uint(at.x), cell.side - 2u), y = min(uint(at.y), cell.side - 2u);
    cell.texel = skyLobeFirst(level) + y * cell.side + x;
    cell.fraction = vec2(at.x - float(x), at.y - float(y));
    return cell;
}

// Between 0 and kSkyLobeLevels - 1.
PENUMBRA_FN float skyLobeLevel(float exponent)
{
    return clamp(log2(max(exponent, 1.0f)) - 2.0f, 0.0f, float(kSkyLobeLevels - 1u));
}

// Where (r.w)^e n.w is largest, but for terms of 1 / e^2: the gradient of its logarithm,
// e r / (r.w) + n / (n.w), is along w there, and w is near r on the right.
PENUMBRA_FN vec3 skyLobeDirection(Receiver receiver)
{
    // Where r grazes, w is not near it: 6 degrees from there on the turn grows no more.
    const float cosine = max(dot(receiver.mirror, receiver.normal), 0.1f);
    return normalize(receiver.glossExponent * receiver.mirror + receiver.normal * (1.0f / cosine));
}

// How much of P A is taken: none up to exponent 4, where SH are right at every angle, and P is so
// only in the mirror direction of the normal; all from 8 on.
PENUMBRA_FN float skyLobeShare(float exponent)
{
    return min(skyLobeLevel(exponent), 1.0f);
}

// The surface mirrors the filtered sky.
PENUMBRA_FN bool mirrorsSky(float glossFraction, float exponent)
{
    return glossFraction > 0.0f && skyLobeShare(exponent) > 0.0f;
}

// A receiver's lobe over the nodes: the integrals of V f and of L V f.
struct GlossSums {
    float visible;
    vec3 reflected;
};

// The lobe times cosine at a node of kShNodes.
PENUMBRA_FN float glossAt(Receiver receiver, ZonalPolynomial phong, vec3 node)
{
    return zonalValue(phong, dot(receiver.mirror, node)) *
           zonalValue(cosinePolynomial(), dot(receiver.normal, node));
}

// What is added to the reflected radiance, which has `sums.reflected` in it; `sky` is P.
PENUMBRA_FN vec3 skyGloss(Receiver receiver, GlossSums sums, vec3 sky)
{
    return receiver.glossFraction * skyLobeShare(receiver.glossExponent) *
           (sky * max(sums.visible, 0.0f) - sums.reflected);
}

PENUMBRA_END
#endif
