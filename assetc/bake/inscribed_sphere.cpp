#include "assetc/bake/inscribed_sphere.h"

#include "assetc/embree_scene.h"
#include "shaders/shared/field.h"

#include <algorithm>

namespace penumbra {

namespace {

constexpr std::uint32_t kCandidateSteps = 8;  // along each edge of a shell's grid
constexpr float kFirstStep = 0.5f;            // of the search, of the ball's radius
constexpr float kFinestStep = 1.0f / 1024.0f; // bounding radii

} // namespace

vec4 inscribedSphere(const EmbreeScene& scene, const FieldSamples& field)
{
    const ShadowField& head = field.head;
    const float reach = 2 * head.radius;
    vec4 best(0);
    const auto consider = [&](vec3 at) {
        const float distance = scene.distance(at, reach);
        const bool larger = distance > best.w;
        if (larger)
            best = vec4(at, distance);
        return larger;
    };
    for (std::size_t s = 0; s < head.shellSides.size(); ++s) {
        const std::uint32_t last = head.shellSides[s] - 1u;
        const std::uint32_t step = std::max(1u, last / kCandidateSteps);
        const std::size_t first = firstNode(head, s);
        for (std::uint32_t y = 0; y <= last; y += step)
            for (std::uint32_t x = 0; x <= last; x += step)
                if (field.inside[first + y * std::size_t{last + 1} + x])
                    consider(head.center +
                             head.radius * shellRadius(head, s) *
                                 octahedralDirection(vec2(x, y) / static_cast<float>(last)));
    }
    // A step shorter than the radius stays in the ball, and so inside.
    for (float step = kFirstStep * best.w; step > kFinestStep * head.radius;) {
        const vec3 from(best);
        bool moved = false;
        for (int axis = 0; axis < 3; ++axis)
            for (const float sign : {-1.0f, 1.0f}) {
                vec3 to = from;
                to[axis] += sign * step;
                moved |= consider(to);
            }
        if (!moved)
            step *= 0.5f;
    }
    return best;
}

} // namespace penumbra
