#include "demo/causes/vertex_interpolation.h"

#include <algorithm>
#include <glm/gtc/matrix_inverse.hpp>

namespace penumbra {

namespace {

// The corner of a triangle as a receiver.
ReferenceReceiver cornerOf(const ReferenceScene& scene, const ReferenceHit& hit, std::size_t corner,
                           vec3 eye)
{
    const ReferenceInstance& instance = scene.instances()[hit.instance];
    const std::uint32_t v = instance.mesh->indices[std::size_t{3} * hit.triangle + corner];
    ReferenceReceiver r;
    r.position = vec3(instance.worldFromObject * vec4(instance.mesh->positions[v], 1));
    r.normal = normalize(glm::inverseTranspose(mat3(instance.worldFromObject)) *
                         instance.mesh->normals[v]);
    r.toEye = normalize(eye - r.position);
    r.material = instance.material;
    r.instance = hit.instance;
    return r;
}

} // namespace

RadianceErrors vertexInterpolation(const ReferenceScene& scene, const ReferenceLighting& lighting,
                                   const ReferenceCamera& camera, std::uint32_t points,
                                   const ReferenceOptions& options)
{
    const auto every =
        std::max(static_cast<std::uint32_t>(std::sqrt(static_cast<double>(camera.width) *
                                                      camera.height / std::max(points, 1u))),
                 1u);
    std::vector<ReferenceReceiver> inside;
    std::array<std::vector<ReferenceReceiver>, 3> corners;
    std::vector<vec3> weights;
    for (std::uint32_t y = every / 2; y < camera.height; y += every)
        for (std::uint32_t x = every / 2; x < camera.width; x += every) {
            const vec3 direction = pixelDirection(camera, std::size_t{y} * camera.width + x);
            const ReferenceHit hit = scene.closest(camera.eye, direction);
            const bool shines = std::any_of(
                lighting.lights.begin(), lighting.lights.end(),
                [&](const AreaLight& light) { return light.instance() == hit.instance; });
            if (!hit.hit || shines)
                continue;
            inside.push_back({hit.position, hit.normal, -direction,
                              scene.instances()[hit.instance].material, hit.instance});
            for (std::size_t k = 0; k < 3; ++k)
                corners[k].push_back(cornerOf(scene, hit, k, camera.eye));
            weights.emplace_back(1 - hit.barycentric.x - hit.barycentric.y, hit.barycentric.x,
                                 hit.barycentric.y);
        }
    const ReferenceRadiance truth = shadeReference(scene, lighting, inside, options);
    std::vector<vec3> interpolated(inside.size(), vec3(0));
    for (std::size_t k = 0; k < 3; ++k) {
        const std::vector<vec3> corner =
            shadeReference(scene, lighting, corners[k], options).shadowed;
        for (std::size_t i = 0; i < corner.size(); ++i)
            interpolated[i] += weights[i][static_cast<int>(k)] * corner[i];
    }
    return compareRadiance(interpolated, truth.shadowed, truth.unshadowed);
}

} // namespace penumbra
