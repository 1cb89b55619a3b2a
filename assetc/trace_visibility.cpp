#include "assetc/trace_visibility.h"

#include <algorithm>
#include <array>
#include <glm/gtc/constants.hpp>
#include <limits>

namespace penumbra {

namespace {

constexpr std::size_t kPacket = 16;

} // namespace

Sh4 traceBlocked(RTCScene scene, vec3 origin, const std::vector<vec3>& directions,
                 const std::vector<Sh4>& basis)
{
    std::array<double, 16> blocked{};
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (std::size_t first = 0; first < directions.size(); first += kPacket) {
        alignas(64) RTCRay16 rays{};
        alignas(64) std::array<int, kPacket> valid{};
        const std::size_t count = std::min(kPacket, directions.size() - first);
        for (std::size_t k = 0; k < count; ++k) {
            const vec3 d = directions[first + k];
            valid[k] = -1;
            rays.org_x[k] = origin.x;
            rays.org_y[k] = origin.y;
            rays.org_z[k] = origin.z;
            rays.dir_x[k] = d.x;
            rays.dir_y[k] = d.y;
            rays.dir_z[k] = d.z;
            rays.tfar[k] = std::numeric_limits<float>::infinity();
            rays.mask[k] = ~0u;
        }
        rtcOccluded16(valid.data(), scene, &context, &rays);
        for (std::size_t k = 0; k < count; ++k)
            if (rays.tfar[k] < 0) // Embree's mark of a hit
                for (std::size_t i = 0; i < blocked.size(); ++i)
                    blocked[i] += basis[first + k].c[i];
    }
    Sh4 sum{};
    for (std::size_t i = 0; i < blocked.size(); ++i)
        sum.c[i] = static_cast<float>(blocked[i]);
    return sum;
}

Sh4 traceVisibility(RTCScene scene, vec3 origin, const std::vector<vec3>& directions,
                    const std::vector<Sh4>& basis)
{
    const Sh4 blocked = traceBlocked(scene, origin, directions, basis);
    Sh4 visibility{};
    const double weight = 4 * glm::pi<double>() / static_cast<double>(directions.size());
    for (int i = 0; i < 16; ++i)
        visibility.c[i] = static_cast<float>((i == 0 ? kSqrt4Pi : 0.0) - weight * blocked.c[i]);
    return visibility;
}

} // namespace penumbra
