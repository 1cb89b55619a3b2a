#include "assetc/bake/beside_surface.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace penumbra {

namespace {

// Squared distance of p from triangle abc: Ericson, Real-Time Collision Detection, 5.1.5.
float distanceSquared(vec3 p, vec3 a, vec3 b, vec3 c)
{
    const auto to = [&](vec3 q) { return dot(p - q, p - q); };
    const vec3 ab = b - a, ac = c - a;
    const float d1 = dot(ab, p - a), d2 = dot(ac, p - a);
    if (d1 <= 0 && d2 <= 0)
        return to(a);
    const float d3 = dot(ab, p - b), d4 = dot(ac, p - b);
    if (d3 >= 0 && d4 <= d3)
        return to(b);
    const float d5 = dot(ab, p - c), d6 = dot(ac, p - c);
    if (d6 >= 0 && d5 <= d6)
        return to(c);
    const float va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0)
        return to(a + ab * (d1 / (d1 - d3)));
    if (vb <= 0 && d2 >= 0 && d6 <= 0)
        return to(a + ac * (d2 / (d2 - d6)));
    if (va <= 0 && d4 >= d3 && d5 >= d6)
        return to(b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))));
    const float part = 1 / (va + vb + vc);
    return to(a + ab * (vb * part) + ac * (vc * part));
}

struct Query {
    const EmbreeScene* scene;
    bool found = false;
};

bool visitTriangle(RTCPointQueryFunctionArguments* arguments)
{
    auto& query = *static_cast<Query*>(arguments->userPtr);
    const RTCPointQuery& q = *arguments->query;
    const auto [a, b, c] = query.scene->triangle(arguments->primID);
    if (distanceSquared({q.x, q.y, q.z}, a, b, c) >= q.radius * q.radius)
        return false;
    query.found = true;
    arguments->query->radius = 0; // enough is known
    return true;
}

} // namespace

std::vector<std::size_t> pointsBeside(const EmbreeScene& scene, const PointSet& points, vec3 center,
                                      float radius, float distance)
{
    std::vector<char> beside(points.size());
    tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
        const vec3 p(points.x[i], points.y[i], points.z[i]);
        if (length(p) > 1 + distance) // nothing there
            return;
        const vec3 at = center + radius * p;
        Query query{&scene};
        RTCPointQuery embreeQuery{at.x, at.y, at.z, 0, radius * distance};
        RTCPointQueryContext context;
        rtcInitPointQueryContext(&context);
        rtcPointQuery(scene.handle(), &embreeQuery, &context, visitTriangle, &query);
        beside[i] = query.found ? 1 : 0;
    });
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < beside.size(); ++i)
        if (beside[i] != 0)
            out.push_back(i);
    return out;
}

} // namespace penumbra
