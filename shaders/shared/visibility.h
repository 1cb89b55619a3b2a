// Conservative tests of clusters and entities: what they drop cannot be seen, or has no weight.
#ifndef PENUMBRA_SHADERS_SHARED_VISIBILITY_H
#define PENUMBRA_SHADERS_SHARED_VISIBILITY_H
#include "shaders/shared/interop.h"
PENUMBRA_BEGIN

PENUMBRA_FN bool sphereOutside(vec4 plane, vec3 center, float radius)
{
    return dot(vec3(plane.x, plane.y, plane.z), center) + plane.w < -radius;
}

// All faces of a cluster look away from the eye. Every normal n lies within angle a of `axis`
// (unit, cutoff = cos a), every point p in the sphere; view = centre - eye. With theta =
// angle(axis, view), dot(n, p - eye) >= |view| cos(theta + a) - radius while theta + a <= 180
// degrees (Zhou et al. 2005 section 4.2, there for single vertices).
PENUMBRA_FN bool facesAway(vec3 view, vec3 axis, float cutoff, float radius)
{
    if (cutoff <= 0.0f)
        return false;
    const float along = dot(axis, view);
    const float across = length(view - along * axis);
    return along * cutoff - across * sqrt(max(1.0f - cutoff * cutoff, 0.0f)) > radius;
}

// The smallest dot(n, to) over the cone of normals n of a cluster: |to| cos(theta + a). Where that
// is negative, it may be less. to = a point - the cluster's centre.
PENUMBRA_FN float lowestOver(vec3 to, vec3 axis, float cutoff)
{
    const float along = dot(axis, to);
    const float across = length(to - along * axis);
    return cutoff <= 0.0f ? -length(to)
                          : along * cutoff - across * sqrt(max(1.0f - cutoff * cutoff, 0.0f));
}

// The largest dot(n, to) over the cone of normals n of a cluster: |to| cos(max(0, theta - a)).
// to = a point - the cluster's centre.
PENUMBRA_FN float highestOver(vec3 to, vec3 axis, float cutoff)
{
    const float distance = length(to);
    const float along = dot(axis, to);
    const float across = length(to - along * axis);
    return cutoff <= 0.0f || along >= cutoff * distance
               ? distance
               : along * cutoff + across * sqrt(max(1.0f - cutoff * cutoff, 0.0f));
}

// A sphere lies under the horizon of every receiver of a cluster: highest = highestOver of its
// centre, radius = the cluster's.
PENUMBRA_FN bool belowHorizon(float highest, float sphereRadius, float radius)
{
    return highest < -(radius + sphereRadius);
}

// How much an entity can matter to a cluster: its solid angle, about, and 0 from where it is out of
// influence or under the horizon of every receiver. It changes smoothly where the entity moves.
// highest = highestOver(to, ...), radius = the cluster's.
PENUMBRA_FN float entityImportance(vec3 to, float highest, float sphereRadius, float influence,
                                   float radius)
{
    const float within = clamp(1.0f - (length(to) - radius) / influence, 0.0f, 1.0f);
    const float risen = clamp(1.0f + highest / (radius + sphereRadius), 0.0f, 1.0f);
    const float square = sphereRadius * sphereRadius;
    return within * risen * square / max(square + dot(to, to), 1e-30f);
}

// What of an entity counts, beside those of a full list: `least` is the importance of the most
// important one left out, 0 where none is. 0 at equal importance, so the two change places unseen;
// why the band is a quarter wide: docs/decisions/0008.
PENUMBRA_FN float entityShare(float importance, float least)
{
    return least > 0.0f ? clamp(4.0f * (importance / least - 1.0f), 0.0f, 1.0f) : 1.0f;
}

// How much a sphere counts for one receiver: 0 once it lies under the receiver's horizon, where the
// products of order 4 would still leak, 1 from where its centre has risen; so what belowHorizon
// drops had no weight. to = its centre - the receiver.
PENUMBRA_FN float horizonWeight(vec3 normal, vec3 to, float sphereRadius)
{
    const float t = clamp(1.0f + dot(normal, to) / sphereRadius, 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

// The shadow that a ball (centre, radius) casts from a point: the cone of the rays that meet it,
// beyond the plane through its centre that faces the point.
struct BallShadow {
    vec3 axis; // unit, from the point to the ball
    float distance;
    float sine, cosine; // of the cone's half-angle
};

PENUMBRA_FN BallShadow ballShadow(vec3 toBall, float radius)
{
    BallShadow shadow;
    shadow.distance = max(length(toBall), 1e-9f);
    shadow.axis = toBall * (1.0f / shadow.distance);
    shadow.sine = clamp(radius / shadow.distance, 0.0f, 1.0f);
    shadow.cosine = sqrt(1.0f - shadow.sine * shadow.sine);
    return shadow;
}

// A ball hides whole from this sine of its half-angle on, in part from the least one on: so it has
// done before its object is out of influence, at kHiderReach radii. There a ball that lies in the
// bounding sphere is at least 8 of its own radii away, wherever in the sphere.
PENUMBRA_CONST float kHiderReach = 8.0f;
PENUMBRA_CONST float kLeastHiderSine = 1.0f / 7.0f;
PENUMBRA_CONST float kWholeHiderSine = 1.0f / 5.0f;

// A sphere begins to be hidden when its centre lies so deep in the shadow, in its radii: with a
// quarter of its width outside. Why then: docs/decisions/0011.
PENUMBRA_CONST float kHidingDepth = 0.5f;

// A point from the cone's tip: along the axis, and across it.
PENUMBRA_FN vec2 alongAcross(BallShadow shadow, vec3 to)
{
    const float along = dot(to, shadow.axis);
    return vec2(along, sqrt(max(dot(to, to) - along * along, 0.0f)));
}

// How deep such a point lies in the cone, metres; negative outside.
PENUMBRA_FN float coneDepth(BallShadow shadow, vec2 at)
{
    return at.x * shadow.sine - at.y * shadow.cosine;
}

// What the inscribed ball of an occluder leaves of an entity for one receiver: 0 once its sphere
// lies wholly in the ball's shadow, where the products of order 4 would still leak, 1 down
// to kHidingDepth; so what is dropped as hidden had no weight. counts: how much the occluder itself
// counts for the receiver, by its share and the horizon; it hides as much.
PENUMBRA_FN float unhidden(vec3 point, vec4 ball, vec4 sphere, float counts)
{
    const BallShadow shadow = ballShadow(vec3(ball) - point, ball.w);
    const vec2 at = alongAcross(shadow, vec3(sphere) - point);
    const float depth = min(coneDepth(shadow, at), at.x - shadow.distance);
    const float t = clamp((1.0f - depth / sphere.w) / (1.0f - kHidingDepth), 0.0f, 1.0f);
    const float large =
        clamp((shadow.sine - kLeastHiderSine) / (kWholeHiderSine - kLeastHiderSine), 0.0f, 1.0f);
    return mix(1.0f, t * t * (3.0f - 2.0f * t), large * counts);
}

// What bounds unhidden() over the points of a cluster. From one at an offset the ball and a sphere
// look as they do from the cluster's centre when both are moved the other way, so a smaller and a
// larger ball bound the cone; the plane turns, by less than `tilt` where the sphere is.
struct ClusterShadow {
    BallShadow least, most; // with axis and distance the same
    float radius;           // of the cluster
    float turn;             // of the axis, at most
    bool whole, any;        // the ball is seen large enough from each point, from one
};

// cluster, ball: centre, radius. A ball of radius 0 casts no shadow.
PENUMBRA_FN ClusterShadow clusterShadow(vec4 cluster, vec4 ball)
{
    const vec3 toBall = vec3(ball) - vec3(cluster);
    ClusterShadow shadow;
    shadow.least = ballShadow(toBall, ball.w - cluster.w);
    shadow.most = ballShadow(toBall, ball.w + cluster.w);
    shadow.radius = cluster.w;
    shadow.turn = cluster.w / max(shadow.least.distance - cluster.w, 1e-9f);
    shadow.whole = ball.w >= kWholeHiderSine * (shadow.least.distance + cluster.w);
    shadow.any = ball.w > 0.0f && ball.w >= kLeastHiderSine * (shadow.least.distance - cluster.w);
    return shadow;
}

// What holds of a sphere for the receivers of a cluster: unhidden() is 0 for each, if the occluder
// counts whole; it may be less than 1 for one.
struct ShadowBounds {
    bool hidden, touched;
};

// to = the sphere's centre - the cluster's.
PENUMBRA_FN ShadowBounds shadowBounds(ClusterShadow shadow, vec3 to, float sphereRadius)
{
    const vec2 at = alongAcross(shadow.least, to);
    const float behind = at.x - shadow.least.distance;
    const float tilt = (at.y + abs(behind)) * shadow.turn;
    const float begins = kHidingDepth * sphereRadius;
    ShadowBounds bounds;
    bounds.hidden = shadow.whole && shadow.least.sine > 0.0f && behind - tilt >= sphereRadius &&
                    coneDepth(shadow.least, at) >= sphereRadius + shadow.radius;
    bounds.touched =
        shadow.any && behind + tilt > begins &&
        (shadow.most.sine == 1.0f || coneDepth(shadow.most, at) > begins - shadow.radius);
    return bounds;
}

PENUMBRA_END
#endif
