// The outline of a turned shape: points (distance from the axis, height), metres, sampled as they
// are drawn.
//   Profile p({0, 0}, 0.01f);
//   p.lineTo({0.1f, 0}).curveTo({0.1f, 0.1f}, {0.05f, 0.2f}, {0, 0.2f});
//   builder.addSkin(latheRings(p.points(), 64), false);
#pragma once

#include "demo/content/mesh_builder.h"

namespace penumbra {

vec2 cubicBezier(vec2 a, vec2 b, vec2 c, vec2 d, float t);

class Profile {
public:
    // `spacing`: the largest distance between samples, metres. Ends of segments are always samples.
    Profile(vec2 start, float spacing) : m_points{start}, m_spacing(spacing) {}

    Profile& lineTo(vec2 end);
    Profile& curveTo(vec2 control1, vec2 control2, vec2 end); // cubic Bézier
    Profile& arcTo(vec2 centre, vec2 end);                    // the shorter way round `centre`
    Profile& splineTo(std::span<const vec2> through); // Catmull-Rom, ends tangent to their chords

    std::span<const vec2> points() const { return m_points; }

private:
    std::vector<vec2> m_points;
    float m_spacing;
};

// The profile turned about the y axis. It must start and end on the axis.
std::vector<Ring> latheRings(std::span<const vec2> profile, int sides);

} // namespace penumbra
