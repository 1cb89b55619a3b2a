#include "assets/bounding_sphere.h"

#include "runtime/assert.h"

#include <algorithm>

namespace penumbra {

Sphere boundingSphere(std::span<const vec3> points, int steps)
{
    PENUMBRA_ASSERT(!points.empty(), "a sphere around nothing");
    constexpr float kSlack = 1.0f + 1e-5f;
    vec3 low = points.front(), high = low;
    for (const vec3 point : points) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    Sphere best;
    vec3 center = 0.5f * (low + high);
    for (int step = 0; step <= steps; ++step) {
        vec3 farthest = points.front();
        float squared = -1;
        for (const vec3 point : points)
            if (const float d = dot(point - center, point - center); d > squared) {
                squared = d;
                farthest = point;
            }
        if (const float radius = std::sqrt(squared) * kSlack; step == 0 || radius < best.radius)
            best = {center, radius};
        center += (farthest - center) / static_cast<float>(step + 2);
    }
    return best;
}

} // namespace penumbra
