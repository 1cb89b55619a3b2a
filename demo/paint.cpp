#include "demo/paint.h"

#include "systems/transforms.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>

namespace penumbra {

namespace {

// Where the ray origin + t direction enters the box, t > 0; infinity where it does not.
float enterBox(vec3 origin, vec3 direction, vec3 low, vec3 high)
{
    const vec3 a = (low - origin) / direction, b = (high - origin) / direction;
    const vec3 near = glm::min(a, b), far = glm::max(a, b);
    const float enter = std::max({near.x, near.y, near.z, 0.0f});
    const float leave = std::min({far.x, far.y, far.z});
    return enter <= leave ? enter : std::numeric_limits<float>::infinity();
}

} // namespace

std::optional<ecs::Entity> pick(DemoScene& scene, const View& view, vec2 clip)
{
    const vec4 far = glm::inverse(view.clipFromWorld) * vec4(clip, 1, 1);
    const vec3 direction = normalize(vec3(far) / far.w - view.eye);
    std::optional<ecs::Entity> nearest;
    float distance = std::numeric_limits<float>::infinity();
    scene.world.query<const MeshInstance, ecs::With<Transform>, ecs::With<Material>>().each(
        [&](ecs::Entity entity, const MeshInstance& instance) {
            const Transform& at = worldTransform(scene.world, entity);
            const MeshAsset& mesh = scene.assets.mesh(instance.asset);
            const vec4 back(-vec3(at.rotation), at.rotation.w);
            const float t =
                enterBox(rotate(back, view.eye - at.position) / at.scale,
                         rotate(back, direction) / at.scale, mesh.boundsMin, mesh.boundsMax);
            if (t < distance) {
                distance = t;
                nearest = entity;
            }
        });
    return nearest;
}

bool paint(DemoScene& scene, const View& view, vec2 clip, const PaintKeys& keys)
{
    if (!keys.toggle && keys.factor == 1)
        return false;
    const std::optional<ecs::Entity> picked = pick(scene, view, clip);
    if (!picked)
        return false;
    Material material = *scene.world.tryGet<const Material>(*picked);
    if (keys.toggle)
        material.glossFraction = material.glossFraction > 0 ? 0.0f : 0.6f;
    material.glossExponent = clamp(max(material.glossExponent, 1.0f) * keys.factor, 1.0f, 1024.0f);
    scene.world.set(*picked, material);
    fmt::print("gloss fraction {:.2f}, exponent {:.0f}\n", material.glossFraction,
               material.glossExponent);
    return true;
}

} // namespace penumbra
