#include "tests/bench/bench_knot.h"

#include <glm/gtc/constants.hpp>

namespace penumbra {

MeshAsset torusKnot(std::size_t triangles)
{
    const auto around = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(triangles) / 20));
    const std::uint32_t along = 10 * around; // 2 * around * along triangles
    const auto spine = [](float t) {
        const float r = 2 + std::cos(3 * t);
        return vec3(r * std::cos(2 * t), r * std::sin(2 * t), -std::sin(3 * t));
    };
    MeshAsset mesh;
    for (std::uint32_t i = 0; i < along; ++i) {
        const float t = glm::two_pi<float>() * static_cast<float>(i) / static_cast<float>(along);
        const vec3 center = spine(t);
        const vec3 tangent = normalize(spine(t + 1e-3f) - spine(t - 1e-3f));
        const vec3 side = normalize(cross(tangent, vec3(center.x, center.y, 0)));
        const vec3 up = cross(tangent, side);
        for (std::uint32_t j = 0; j < around; ++j) {
            const float a =
                glm::two_pi<float>() * static_cast<float>(j) / static_cast<float>(around);
            const vec3 normal = side * std::cos(a) + up * std::sin(a);
            mesh.positions.push_back(center + 0.45f * normal);
            mesh.normals.push_back(normal);
            const std::uint32_t nextRing = (i + 1) % along * around, ring = i * around;
            const std::uint32_t next = (j + 1) % around;
            for (const std::uint32_t corner :
                 {ring + j, ring + next, nextRing + j, nextRing + j, ring + next, nextRing + next})
                mesh.indices.push_back(corner);
        }
    }
    updateDerived(mesh);
    return mesh;
}

} // namespace penumbra
