// Convex hulls of points: made, reduced, and measured. Used while shapes are built, never per step.
#pragma once

#include "runtime/result.h"
#include "shaders/shared/interop.h"

#include <array>
#include <span>
#include <vector>

namespace penumbra {

struct ConvexHull {
    std::vector<vec3> points;                            // metres
    std::vector<std::array<std::uint32_t, 3>> triangles; // counter-clockwise from outside
    float gap = 0; // metres: how far inside the hull that it was reduced from it lies, on average
};

// Of a solid of density 1. Sums of solids are sums of these.
struct MassIntegrals {
    double volume = 0;    // m³
    glm::dvec3 first{0};  // ∫ x, m⁴
    glm::dmat3 second{0}; // ∫ x xᵀ, m⁵
};

// Errors: a coordinate that is not finite or beyond 1e4 m; points within a plane, a line or a
// point.
Result<ConvexHull> convexHull(std::span<const vec3> points);

// A hull of at most `maxPoints` >= 6 of the same points, which fits inside: the six extremes along
// the axes, then, again and again, the point that lies farthest outside. Stops early within 0.2 %
// of the size.
ConvexHull reduceHull(const ConvexHull& hull, std::size_t maxPoints);

// The hull with its faces moved in by `distance`, or less if little would remain; for engines that
// pad hulls.
struct ShrunkHull {
    std::vector<vec3> points;
    float distance = 0; // by how much, metres
};
ShrunkHull shrinkHull(const ConvexHull& hull, float distance);

// Of any closed surface; parts that overlap count twice.
MassIntegrals integrate(std::span<const vec3> points,
                        std::span<const std::array<std::uint32_t, 3>> triangles);
inline MassIntegrals integrate(const ConvexHull& hull)
{
    return integrate(hull.points, hull.triangles);
}

} // namespace penumbra
