// Beams: the bright part of the environments as directional lights, each with a shadow map. Fields
// of order 4 blur every light whose half-angle is below some 25 degrees; what shines from a
// smaller solid angle casts its shadow from here (docs/decisions/0015).
// The soft edge is that of percentage-closer soft shadows (Fernando 2005): the mean distance of
// what blocks tells how wide the penumbra is, a disc of that size how much of the light is left.
#ifndef PENUMBRA_SHADERS_SHARED_BEAM_H
#define PENUMBRA_SHADERS_SHARED_BEAM_H
#include "shaders/shared/interop.h"
PENUMBRA_BEGIN

PENUMBRA_CONST uint kMaxBeams = 32u;
PENUMBRA_CONST uint kBeamMapSide = 1024u;  // texels of a beam's shadow map
PENUMBRA_CONST uint kBeamMapColumns = 8u;  // the maps lie in one image, row by row
PENUMBRA_CONST uint kBeamTaps = 8u;        // of the search for blockers, and of the filter
PENUMBRA_CONST float kBeamSteepest = 4.0f; // slope of a receiver's plane in its beam, at most
PENUMBRA_CONST float kBeamWidest = 0.125f; // radius of taps, of the map's size, at most

// A directional light and the orthographic map of what stands in its way.
struct GpuBeam {
    vec4 u;          // . (world point, 1) = place in the map, 0 … 1 from its left
    vec4 v;          // likewise from its top
    vec4 depth;      // likewise below the top of what casts shadows, 0, down to its bottom, 1
    vec4 direction;  // unit, world, towards the light; w: tangent of the half-angle that blurs
    vec4 irradiance; // W/m² on a plane across the beam; w: metres from depth 0 to 1
    vec4 size; // metres across the map along u and v; offset of receivers along their normals;
               // tangent of the whole half-angle
};

// Where a receiver looks in the map.
struct BeamPoint {
    vec2 uv;
    float depth;
    vec2 slope; // of its plane: depth per u and v
};

PENUMBRA_FN BeamPoint beamPoint(GpuBeam beam, vec3 position, vec3 normal)
{
    const vec4 p = vec4(position + beam.size.z * normal, 1.0f);
    const float facing = max(dot(normal, vec3(beam.direction)), 1e-4f);
    // u and v are unit axes over the size.
    const vec2 size = vec2(beam.size);
    const vec2 tilt =
        vec2(dot(normal, vec3(beam.u)), dot(normal, vec3(beam.v))) * size * (1.0f / facing);
    const float steep = max(length(tilt), kBeamSteepest) / kBeamSteepest;
    BeamPoint at;
    at.uv = vec2(dot(beam.u, p), dot(beam.v, p));
    at.depth = dot(beam.depth, p);
    at.slope = tilt * size * (1.0f / (steep * beam.irradiance.w));
    return at;
}

// Taps on the unit disc, the first at its centre, equal areas: a spiral by the golden angle (Vogel
// 1979), turned from beam to beam so that edges of neighbours do not fall together.
PENUMBRA_FN vec2 beamTap(uint tap, uint beam)
{
    const float angle = 2.39996323f * float(tap) + 0.7f * float(beam);
    return sqrt(float(tap) / float(kBeamTaps)) * vec2(cos(angle), sin(angle));
}

// Radii in u and v of what a light's disc covers `above` metres above a receiver: a texel at least,
// an eighth of the map at most.
PENUMBRA_FN vec2 beamRadius(GpuBeam beam, float above)
{
    const float radius = beam.direction.w * max(above, 0.0f);
    const float least = 1.0f / float(kBeamMapSide);
    return vec2(clamp(radius / beam.size.x, least, kBeamWidest),
                clamp(radius / beam.size.y, least, kBeamWidest));
}

PENUMBRA_END

#ifdef __cplusplus
static_assert(sizeof(penumbra::GpuBeam) == 96);
#endif
#endif
