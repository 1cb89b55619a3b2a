#include "assetc/bake/inscribed_sphere.h"

#include "assetc/embree_scene.h"
#include "assetc/trace_visibility.h"
#include "runtime/assert.h"
#include "shaders/shared/field.h"

#include <algorithm>

namespace penumbra {

namespace {

constexpr std::uint32_t kCandidateSteps = 8;  // along each edge of a shell's grid
constexpr float kFirstStep = 0.5f;            // of the search, of the ball's radius
constexpr float kAround = 0.7f;               // of the radius: where the ball is looked out of
constexpr float kFinestStep = 1.0f / 1024.0f; // bounding radii

vec4 considered(const EmbreeScene& scene, vec4 best, vec3 at, float reach)
{
    const float distance = scene.distance(at, reach);
    return distance > best.w ? vec4(at, distance) : best;
}

// The best of the nodes inside.
vec4 coarseBall(const EmbreeScene& scene, const FieldSamples& field)
{
    const ShadowField& head = field.head;
    vec4 best(0);
    for (std::size_t s = 0; s < head.shellSides.size(); ++s) {
        PENUMBRA_ASSERT(head.shellSides[s] >= 3, "shell {} is left out", s);
        const std::uint32_t last = head.shellSides[s] - 1u;
        const std::uint32_t step = std::max(1u, last / kCandidateSteps);
        const std::size_t first = firstNode(head, s);
        for (std::uint32_t y = 0; y <= last; y += step)
            for (std::uint32_t x = 0; x <= last; x += step)
                if (field.inside[first + y * std::size_t{last + 1} + x]) {
                    const vec3 direction =
                        octahedralDirection(vec2(x, y) / static_cast<float>(last));
                    best = considered(scene, best,
                                      head.center + head.radius * shellRadius(head, s) * direction,
                                      2 * head.radius);
                }
    }
    return best;
}

// Uphill: no step is longer than the radius, so none crosses the surface.
vec4 grown(const EmbreeScene& scene, vec4 ball, float fieldRadius)
{
    for (float step = kFirstStep * ball.w; step > kFinestStep * fieldRadius;) {
        const vec4 from = ball;
        for (int axis = 0; axis < 3; ++axis)
            for (const float sign : {-1.0f, 1.0f}) {
                vec3 to(from);
                to[axis] += sign * step;
                ball = considered(scene, ball, to, 2 * fieldRadius);
            }
        if (ball == from)
            step *= 0.5f;
    }
    return ball;
}

bool seesNothing(const EmbreeScene& scene, vec4 ball, const std::vector<vec3>& directions,
                 const std::vector<Sh4>& basis)
{
    const auto dark = [&](vec3 at) {
        return -traceBlocked(scene.handle(), at, directions, basis).c[0] < kSeesNothing;
    };
    bool all = dark(vec3(ball));
    for (int axis = 0; axis < 3 && all; ++axis)
        for (const float sign : {-1.0f, 1.0f}) {
            vec3 at(ball);
            at[axis] += sign * kAround * ball.w;
            all = all && dark(at);
        }
    return all;
}

} // namespace

vec4 inscribedSphere(const EmbreeScene& scene, const FieldSamples& field,
                     const std::vector<vec3>& directions, const std::vector<Sh4>& basis)
{
    const vec4 coarse = coarseBall(scene, field);
    for (const vec4& ball : {grown(scene, coarse, field.head.radius), coarse})
        if (ball.w > 0 && seesNothing(scene, ball, directions, basis))
            return ball;
    return vec4(0);
}

} // namespace penumbra
