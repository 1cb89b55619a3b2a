// What the integrators of the reference share: receivers in parallel, and where their rays start.
#pragma once

#include "demo/reference/reference.h"

#include <chrono>
#include <numeric>
#include <tbb/parallel_for.h>

namespace penumbra {

struct ReferencePoint {
    glm::dvec3 shadowed{0}, unshadowed{0};
    std::uint64_t rays = 0;
};

// Calls shadeOne(i) -> ReferencePoint for all i < count in parallel and fills the arrays.
template <class F>
ReferenceRadiance shadeAll(std::size_t count, const F& shadeOne)
{
    constexpr std::size_t kGrain = 16; // receivers per task: some milliseconds
    const auto start = std::chrono::steady_clock::now();
    ReferenceRadiance result;
    result.shadowed.resize(count);
    result.unshadowed.resize(count);
    std::vector<std::uint64_t> rays((count + kGrain - 1) / kGrain);
    tbb::parallel_for(std::size_t{0}, rays.size(), [&](std::size_t block) {
        for (std::size_t i = block * kGrain; i < std::min(count, (block + 1) * kGrain); ++i) {
            const ReferencePoint point = shadeOne(i);
            result.shadowed[i] = vec3(point.shadowed);
            result.unshadowed[i] = vec3(point.unshadowed);
            rays[block] += point.rays;
        }
    });
    result.rays = std::accumulate(rays.begin(), rays.end(), std::uint64_t{0});
    result.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

// How far rays start off the surface of the instance, metres.
inline float rayOffset(const ReferenceScene& scene, std::uint32_t instance,
                       const ReferenceOptions& options)
{
    if (instance == kNoInstance)
        return 0.0f;
    return min(options.offset * scene.instanceRadius(instance), options.maxOffset);
}

} // namespace penumbra
