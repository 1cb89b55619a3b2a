// Which of two bounding spheres stands before the other, as a weight that changes smoothly with the
// place of the receiver and of the spheres. An occluder dims a light only where it is nearer (Zhou
// et al. 2005, Fig. 5, sort by distance and forbid spheres that overlap).
//
// Near and far go by power distance, d^2 - r^2: the points where two spheres have equal power make
// a plane, and disjoint spheres lie on both sides of it, so a ray from a point meets the spheres in
// the order of the point's power distances. A swap happens on that plane, where no ray meets both.
// Spheres that overlap have such a plane too; concentric ones have none, and the larger one is the
// nearer everywhere.
#ifndef PENUMBRA_SHADERS_SHARED_ORDER_H
#define PENUMBRA_SHADERS_SHARED_ORDER_H
#include "shaders/shared/interop.h"
PENUMBRA_BEGIN

// Spheres: centre, radius. Negative inside.
PENUMBRA_FN float powerDistance(vec4 sphere, vec3 point)
{
    const vec3 to = vec3(sphere.x, sphere.y, sphere.z) - point;
    return dot(to, to) - sphere.w * sphere.w;
}

// Distance between the centres, but no less than either radius: what keeps the order of spheres
// that overlap from turning round within a hair's breadth.
PENUMBRA_FN float orderSpan(vec4 a, vec4 b)
{
    const vec3 apart = vec3(a.x - b.x, a.y - b.y, a.z - b.z);
    return max(length(apart), max(a.w, b.w));
}

// How far the point lies from the plane of equal power, metres, > 0 on the occluder's side (exact
// where the spheres are disjoint). Linear in the point: it changes by at most 1 per metre.
PENUMBRA_FN float orderSide(vec4 occluder, vec4 light, vec3 point)
{
    return (powerDistance(light, point) - powerDistance(occluder, point)) /
           (2.0f * orderSpan(occluder, light));
}

// Half the width of the band in which the order changes, metres.
PENUMBRA_FN float orderBand(vec4 occluder, vec4 light)
{
    return 0.5f * min(occluder.w, light.w);
}

// 1: the occluder stands before the light; 0: behind it.
PENUMBRA_FN float orderWeight(vec4 occluder, vec4 light, vec3 point)
{
    const float t = clamp(0.5f + 0.5f * orderSide(occluder, light, point) /
                                     max(orderBand(occluder, light), 1e-9f),
                          0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

// The weight for all points of a sphere: 1 or 0 where it is that for every one of them, else
// between.
PENUMBRA_FN float orderWeightAround(vec4 occluder, vec4 light, vec3 center, float radius)
{
    const float side = orderSide(occluder, light, center);
    const float reach = orderBand(occluder, light) + radius;
    return side >= reach ? 1.0f : (side <= -reach ? 0.0f : 0.5f);
}

PENUMBRA_END
#endif
