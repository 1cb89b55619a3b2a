#include "demo/sky_control.h"

#include "demo/sky_motion.h"
#include "runtime/ecs/name.h"
#include "systems/rotation.h"

#include <algorithm>
#include <glm/gtc/quaternion.hpp>

namespace penumbra {

namespace {

std::vector<ecs::Entity> takeSkies(ecs::World& world)
{
    std::vector<ecs::Entity> entities;
    world.query<ecs::With<EnvironmentLight>>().each(
        [&](ecs::Entity entity) { entities.push_back(entity); });
    for (const ecs::Entity entity : entities)
        world.remove<SkyMotion>(entity);
    return entities;
}

} // namespace

void turnSky(ecs::World& world, float radians)
{
    const quat turn = glm::angleAxis(radians, vec3(0, 1, 0));
    for (const ecs::Entity entity : takeSkies(world)) {
        vec4& rotation = world.get<EnvironmentLight>(entity).rotation;
        const quat q = normalize(turn * toQuat(rotation)); // steps add up
        rotation = toVec4(q);
    }
}

void scaleSky(ecs::World& world, float factor)
{
    constexpr float kDarkest = 1e-3f, kBrightest = 1e3f; // a key held down stays in range
    for (const ecs::Entity entity : takeSkies(world)) {
        float& intensity = world.get<EnvironmentLight>(entity).intensity;
        float scaled = intensity * factor;
        if (SkyFade* fade = world.tryGet<SkyFade>(entity)) {
            fade->to *= factor;
            fade->perSecond *= factor;
        } else if (intensity > 0) { // what is gone stays so
            scaled = std::clamp(scaled, kDarkest, kBrightest);
        }
        intensity = scaled;
    }
}

Result<void> fadeToNextSky(DemoScene& scene, const std::filesystem::path& assets, float seconds)
{
    ecs::World& world = scene.world;
    const std::vector<std::string> names = environmentNames(assets);
    const std::vector<ecs::Entity> before = takeSkies(world);
    float sum = 0;
    for (const ecs::Entity entity : before)
        sum += world.get<const EnvironmentLight>(entity).intensity;
    if (names.empty() || sum == 0)
        return {}; // nothing shines that could fade

    // The one that shows, or comes, most is what the next one follows.
    const auto goalOf = [&](ecs::Entity entity) {
        const SkyFade* fade = world.tryGet<const SkyFade>(entity);
        return fade != nullptr ? fade->to : world.get<const EnvironmentLight>(entity).intensity;
    };
    const ecs::Entity current =
        *std::max_element(before.begin(), before.end(),
                          [&](ecs::Entity a, ecs::Entity b) { return goalOf(a) < goalOf(b); });
    const ecs::Name* name = world.tryGet<const ecs::Name>(current);
    const auto following =
        name != nullptr ? std::upper_bound(names.begin(), names.end(), name->text()) : names.end();
    const vec4 rotation = world.get<const EnvironmentLight>(current).rotation;
    const Result<ecs::Entity> next =
        addEnvironment(scene, assets, following != names.end() ? *following : names.front(), 0);
    if (!next)
        return next.error();

    for (const ecs::Entity entity : before) {
        const float intensity = world.get<const EnvironmentLight>(entity).intensity;
        if (intensity > 0)
            world.add(entity, SkyFade{0, intensity / seconds});
        else
            world.destroy(entity);
    }
    world.get<EnvironmentLight>(*next).rotation = rotation;
    world.add(*next, SkyFade{sum, sum / seconds});
    return {};
}

} // namespace penumbra
