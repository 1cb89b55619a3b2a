#include "demo/content/profile.h"

#include <algorithm>
#include <glm/gtc/constants.hpp>

namespace penumbra {

namespace {

int pieceCount(float length, float spacing)
{
    return std::max(1, static_cast<int>(std::ceil(length / spacing - 1e-3f)));
}

} // namespace

vec2 cubicBezier(vec2 a, vec2 b, vec2 c, vec2 d, float t)
{
    const float s = 1 - t;
    return s * s * s * a + 3 * s * s * t * b + 3 * s * t * t * c + t * t * t * d;
}

Profile& Profile::lineTo(vec2 end)
{
    const vec2 start = m_points.back();
    const int pieces = pieceCount(length(end - start), m_spacing);
    for (int i = 1; i < pieces; ++i)
        m_points.push_back(mix(start, end, static_cast<float>(i) / static_cast<float>(pieces)));
    m_points.push_back(end);
    return *this;
}

Profile& Profile::curveTo(vec2 control1, vec2 control2, vec2 end)
{
    // Equal steps along the curve, not in the parameter: Newell's knob and bottom bunch up
    // otherwise.
    constexpr int kFine = 256; // chords; their length differs from the curve's by less than 1e-4
    const vec2 start = m_points.back();
    std::vector<vec2> fine{start};
    std::vector<float> travelled{0};
    for (int i = 1; i <= kFine; ++i) {
        fine.push_back(cubicBezier(start, control1, control2, end, static_cast<float>(i) / kFine));
        travelled.push_back(travelled.back() +
                            length(fine[fine.size() - 1] - fine[fine.size() - 2]));
    }
    const int pieces = pieceCount(travelled.back(), m_spacing);
    for (int i = 1; i < pieces; ++i) {
        const float target = travelled.back() * static_cast<float>(i) / static_cast<float>(pieces);
        const auto next =
            std::lower_bound(travelled.begin(), travelled.end(), target) - travelled.begin();
        const auto k = static_cast<std::size_t>(next);
        const float t = (target - travelled[k - 1]) / (travelled[k] - travelled[k - 1]);
        m_points.push_back(mix(fine[k - 1], fine[k], t));
    }
    m_points.push_back(end);
    return *this;
}

Profile& Profile::arcTo(vec2 centre, vec2 end)
{
    const vec2 from = m_points.back() - centre, to = end - centre;
    const float sweep = std::atan2(from.x * to.y - from.y * to.x, dot(from, to));
    const int pieces = pieceCount(length(from) * abs(sweep), m_spacing);
    for (int i = 1; i < pieces; ++i) {
        const float angle = sweep * static_cast<float>(i) / static_cast<float>(pieces);
        const float c = cos(angle), s = sin(angle);
        m_points.push_back(centre + vec2(c * from.x - s * from.y, s * from.x + c * from.y));
    }
    m_points.push_back(end);
    return *this;
}

Profile& Profile::splineTo(std::span<const vec2> through)
{
    std::vector<vec2> knots{m_points.back()};
    knots.insert(knots.end(), through.begin(), through.end());
    const auto tangent = [&](std::size_t i) {
        const std::size_t before = i == 0 ? 0 : i - 1, after = std::min(i + 1, knots.size() - 1);
        return (knots[after] - knots[before]) / static_cast<float>(after - before);
    };
    for (std::size_t i = 0; i + 1 < knots.size(); ++i)
        curveTo(knots[i] + tangent(i) / 3.0f, knots[i + 1] - tangent(i + 1) / 3.0f, knots[i + 1]);
    return *this;
}

std::vector<Ring> latheRings(std::span<const vec2> profile, int sides)
{
    PENUMBRA_ASSERT(profile.front().x == 0 && profile.back().x == 0,
                    "the profile leaves the axis open");
    std::vector<Ring> rings;
    for (const vec2 p : profile) {
        const vec3 centre(0, p.y, 0);
        rings.push_back(p.x == 0 ? Ring{centre}
                                 : ellipseRing(centre, vec3(p.x, 0, 0), vec3(0, 0, p.x), sides));
    }
    return rings;
}

} // namespace penumbra
