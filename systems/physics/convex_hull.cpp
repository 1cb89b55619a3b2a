#include "systems/physics/convex_hull.h"

#include <LinearMath/btConvexHullComputer.h>
#include <algorithm>

namespace penumbra {

namespace {

constexpr float kLargest = 1e4f; // metres; beyond it single precision leaves less than a millimetre

void compute(btConvexHullComputer& computer, std::span<const vec3> points, float shrink,
             float shrinkClamp, float& shrunkBy)
{
    shrunkBy = computer.compute(&points.front().x, sizeof(vec3), static_cast<int>(points.size()),
                                shrink, shrinkClamp);
}

vec3 toVec3(const btVector3& v)
{
    return {v.x(), v.y(), v.z()};
}

// The unshrunk hull of `points`. The computer rounds vertices to a grid, so they are taken from
// where they came.
ConvexHull readHull(const btConvexHullComputer& computer, std::span<const vec3> points)
{
    ConvexHull hull;
    for (int i = 0; i < computer.original_vertex_index.size(); ++i)
        hull.points.push_back(points[static_cast<std::size_t>(computer.original_vertex_index[i])]);
    for (int f = 0; f < computer.faces.size(); ++f) {
        const btConvexHullComputer::Edge* const first = &computer.edges[computer.faces[f]];
        const auto apex = static_cast<std::uint32_t>(first->getSourceVertex());
        for (const auto* edge = first->getNextEdgeOfFace();
             edge->getTargetVertex() != first->getSourceVertex(); edge = edge->getNextEdgeOfFace())
            hull.triangles.push_back({apex, static_cast<std::uint32_t>(edge->getSourceVertex()),
                                      static_cast<std::uint32_t>(edge->getTargetVertex())});
    }
    if (integrate(hull).volume < 0) {
        for (auto& t : hull.triangles)
            std::swap(t[1], t[2]);
    }
    return hull;
}

float extent(std::span<const vec3> points)
{
    vec3 low = points.front(), high = low;
    for (const vec3& p : points) {
        low = min(low, p);
        high = max(high, p);
    }
    return std::max({high.x - low.x, high.y - low.y, high.z - low.z});
}

double area(const ConvexHull& hull)
{
    double sum = 0;
    for (const auto& t : hull.triangles) {
        const vec3 a = hull.points[t[0]];
        sum +=
            0.5 * static_cast<double>(length(cross(hull.points[t[1]] - a, hull.points[t[2]] - a)));
    }
    return sum;
}

} // namespace

Result<ConvexHull> convexHull(std::span<const vec3> points)
{
    if (points.size() < 4)
        return Error{
            fmt::format("a hull of {} points has no volume; give at least 4", points.size())};
    for (const vec3& p : points) {
        // Written so that NaN fails too.
        if (!(abs(p.x) <= kLargest && abs(p.y) <= kLargest && abs(p.z) <= kLargest))
            return Error{fmt::format("point ({}, {}, {}) is not finite or beyond {} m", p.x, p.y,
                                     p.z, kLargest)};
    }
    btConvexHullComputer computer;
    float shrunkBy = 0;
    compute(computer, points, 0, 0, shrunkBy);
    ConvexHull hull = readHull(computer, points);
    const double size = extent(points);
    constexpr double kThinnest =
        1e-6; // of the size cubed; the hull computer's own grid is 1e-4 of the size
    if (hull.points.size() < 4 || !(integrate(hull).volume > kThinnest * size * size * size))
        return Error{fmt::format("the hull of {} points is flat; give it thickness or use a box",
                                 points.size())};
    return hull;
}

ConvexHull reduceHull(const ConvexHull& hull, std::size_t maxPoints)
{
    PENUMBRA_ASSERT(maxPoints >= 6, "{} points", maxPoints);
    if (hull.points.size() <= maxPoints)
        return hull;
    std::vector<vec3> kept;
    const auto keep = [&](vec3 p) {
        if (std::find(kept.begin(), kept.end(), p) == kept.end())
            kept.push_back(p);
    };
    for (int axis = 0; axis < 3; ++axis) {
        const auto below = [axis](vec3 a, vec3 b) { return a[axis] < b[axis]; };
        const auto [low, high] = std::minmax_element(hull.points.begin(), hull.points.end(), below);
        keep(*low);
        keep(*high);
    }

    const float size = extent(hull.points);
    const float tolerance = 0.002f * size;
    ConvexHull reduced;
    for (;;) {
        btConvexHullComputer computer;
        float shrunkBy = 0;
        compute(computer, kept, 0, 0, shrunkBy);
        reduced = readHull(computer, kept);
        std::vector<vec4> planes;
        for (const auto& t : reduced.triangles) {
            const vec3 p = reduced.points[t[0]], q = reduced.points[t[1]], r = reduced.points[t[2]];
            const vec3 n = cross(q - p, r - p);
            const float longest = std::max({length(q - p), length(r - q), length(p - r)});
            constexpr float kSliver =
                0.005f; // of the size, high: its normal is noise, its neighbours' planes do
            if (length(n) > kSliver * size * longest)
                planes.push_back(vec4(normalize(n), -dot(normalize(n), p)));
        }
        float farthest = tolerance;
        vec3 next(0);
        for (const vec3& p : hull.points) {
            for (const vec4& plane : planes) {
                const float outside = dot(vec3(plane), p) + plane.w;
                if (outside > farthest) {
                    farthest = outside;
                    next = p;
                }
            }
        }
        if (farthest == tolerance || kept.size() == maxPoints) {
            reduced.gap = static_cast<float>((integrate(hull).volume - integrate(reduced).volume) /
                                             area(reduced));
            return reduced;
        }
        kept.push_back(next);
    }
}

ShrunkHull shrinkHull(const ConvexHull& hull, float distance)
{
    btConvexHullComputer computer;
    ShrunkHull shrunk;
    // 0.5: at most half of the way from a face to the centre.
    compute(computer, hull.points, distance, 0.5f, shrunk.distance);
    if (shrunk.distance < 0) { // nothing would remain
        shrunk.distance = 0;
        shrunk.points = hull.points;
        return shrunk;
    }
    for (int i = 0; i < computer.vertices.size(); ++i)
        shrunk.points.push_back(toVec3(computer.vertices[i]));
    return shrunk;
}

// Tetrahedra from the origin: volume v, ∫ x = v/4 Σp, ∫ x xᵀ = v/20 (Σ p pᵀ + (Σp)(Σp)ᵀ).
MassIntegrals integrate(std::span<const vec3> points,
                        std::span<const std::array<std::uint32_t, 3>> triangles)
{
    MassIntegrals sum;
    for (const auto& t : triangles) {
        const glm::dvec3 a(points[t[0]]), b(points[t[1]]), c(points[t[2]]), total = a + b + c;
        const double volume = dot(a, cross(b, c)) / 6;
        sum.volume += volume;
        sum.first += volume / 4 * total;
        sum.second += volume / 20 *
                      (outerProduct(a, a) + outerProduct(b, b) + outerProduct(c, c) +
                       outerProduct(total, total));
    }
    return sum;
}

} // namespace penumbra
