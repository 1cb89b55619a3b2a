// Which of two bounding spheres stands before the other, as a weight that changes smoothly with the
// place of the receiver and of the spheres. An occluder dims a light only where it is nearer (Zhou
// et al. 2005, Fig. 5, sort by distance and forbid spheres that overlap).
//
// Near and far go by power distance, d^2 - r^2: the points where two spheres have equal power make
// a plane, and disjoint spheres lie on both sides of it, so a ray from a point meets the spheres in
// the order of the point's power distances, and no ray from the plane itself meets both
// (Aurenhammer, "Power diagrams: properties, algorithms and applications", SIAM J. Comput. 16(1),
// 1987). Spheres that overlap are shrunk until they touch, so that the plane stays between their
// centres: a lamp over a table is before it from above and behind it from below. Concentric ones
// have no order: the weight is 1/2.
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

// How an occluder and a light lie to each other.
struct EntityOrder {
    vec4 occluder, light; // the spheres, shrunk
    vec3 middle;
    float span; // distance of the centres, but no less than either radius: what keeps the order of
                // spheres that overlap from turning round within a hair's breadth
    float band; // half the width, near the spheres, of where the order changes, metres
};

PENUMBRA_FN EntityOrder entityOrder(vec4 occluder, vec4 light)
{
    const vec3 a = vec3(occluder.x, occluder.y, occluder.z), b = vec3(light.x, light.y, light.z);
    const float apart = length(a - b);
    const float shrink = min(1.0f, apart / max(occluder.w + light.w, 1e-9f));
    EntityOrder order;
    order.occluder = vec4(a, shrink * occluder.w);
    order.light = vec4(b, shrink * light.w);
    order.middle = 0.5f * (a + b);
    order.span = max(apart, max(occluder.w, light.w));
    order.band = 0.5f * min(occluder.w, light.w);
    return order;
}

// How far the point lies from the plane of equal power, metres, > 0 on the occluder's side (exact
// where the spheres are disjoint). Linear in the point: it changes by at most 1 per metre.
PENUMBRA_FN float orderSide(EntityOrder order, vec3 point)
{
    return (powerDistance(order.light, point) - powerDistance(order.occluder, point)) /
           (2.0f * order.span);
}

// Half the width of the band at `distance` from the middle. It grows with the distance, as fast as
// the plane sweeps past a far point when one of the spheres moves.
PENUMBRA_FN float orderBand(EntityOrder order, float distance)
{
    return max(order.band * max(1.0f, distance / order.span), 1e-9f);
}

// 1: the occluder stands before the light; 0: behind it.
PENUMBRA_FN float orderWeight(vec4 occluder, vec4 light, vec3 point)
{
    const EntityOrder order = entityOrder(occluder, light);
    const float band = orderBand(order, length(point - order.middle));
    const float t = clamp(0.5f + 0.5f * orderSide(order, point) / band, 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

// The weight for all points of a sphere: 1 or 0 where it is that for every one of them, else
// between.
PENUMBRA_FN float orderWeightAround(vec4 occluder, vec4 light, vec3 center, float radius)
{
    const EntityOrder order = entityOrder(occluder, light);
    const float side = orderSide(order, center);
    const float reach = orderBand(order, length(center - order.middle) + radius) + radius;
    return side >= reach ? 1.0f : (side <= -reach ? 0.0f : 0.5f);
}

PENUMBRA_END
#endif
