#include "demo/scenes/sky.h"

#include "demo/scenes/objects.h"
#include "demo/sky_motion.h"

#include <glm/gtc/constants.hpp>

namespace penumbra {

namespace {

constexpr FloorObject kObjects[] = {
    {"bunny", 0.70f, {-0.62f, -0.12f}, 0.5f, {0.72f, 0.70f, 0.67f}, 0, 0},
    {"teapot", 0.62f, {0.55f, -0.42f}, 2.6f, {0.70f, 0.40f, 0.26f}, 0.4f, 4},
    {"knight", 0.62f, {0.18f, 0.34f}, 2.2f, {0.76f, 0.70f, 0.58f}, 0, 0},
    {"chess_pawn", 0.48f, {0.92f, 0.36f}, 0, {0.28f, 0.44f, 0.62f}, 0, 0},
    {"mug", 0.34f, {-0.38f, 0.78f}, 3.6f, {0.34f, 0.56f, 0.40f}, 0, 0},
    {"rounded_cube", 0.30f, {-1.14f, 0.58f}, 0.6f, {0.74f, 0.62f, 0.34f}, 0, 0},
    {"gear", 0.50f, {-0.10f, -0.95f}, 0.3f, {0.66f, 0.68f, 0.72f}, 0.4f, 4},
};

constexpr float kSeconds = 8;

} // namespace

Result<std::unique_ptr<DemoScene>> loadSkyScene(const SceneOptions& options)
{
    Result<std::unique_ptr<DemoScene>> made = makeFloorScene(options, "sky", "courtyard");
    if (!made)
        return made;
    std::unique_ptr<DemoScene> scene = std::move(*made);
    scene->camera = {.target = vec3(0, 0.34f, 0),
                     .distance = 3.4f,
                     .yaw = 0.5f,
                     .pitch = 0.27f, // the horizon is in sight
                     .fieldOfView = 0.72f,
                     .exposure = 0.75f};
    const Result<ecs::Entity> other = addEnvironment(*scene, options.assets, "sunset", 0);
    if (!other)
        return other.error();
    std::vector<ecs::Entity> skies;
    scene->world.query<ecs::With<EnvironmentLight>>().each(
        [&](ecs::Entity entity) { skies.push_back(entity); });
    for (const ecs::Entity entity : skies)
        scene->world.add(entity, SkyMotion{.turn = glm::two_pi<float>() / kSeconds,
                                           .period = kSeconds,
                                           .phase = entity == *other ? 0.5f : 0.0f});
    if (Result<void> placed = placeObjects(*scene, options, kObjects); !placed)
        return placed.error();
    return scene;
}

} // namespace penumbra
