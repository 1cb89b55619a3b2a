#include "demo/scenes/lights.h"

#include "demo/orbit.h"
#include "demo/scenes/objects.h"

#include <glm/gtc/constants.hpp>

namespace penumbra {

namespace {

constexpr FloorObject kObjects[] = {
    {"teapot", 0.62f, {-0.62f, 0.18f}, 0.5f, {0.75f, 0.72f, 0.70f}, 0.4f, 4},
    {"knight", 0.55f, {0.62f, -0.10f}, 2.4f, {0.72f, 0.70f, 0.66f}, 0, 0},
    {"chess_pawn", 0.46f, {0.28f, 0.62f}, 0, {0.70f, 0.66f, 0.58f}, 0, 0},
    {"chess_pawn", 0.46f, {0.95f, 0.52f}, 0, {0.62f, 0.60f, 0.58f}, 0, 0},
    {"mug", 0.34f, {-0.22f, 0.86f}, 3.9f, {0.68f, 0.68f, 0.70f}, 0, 0},
    {"rounded_cube", 0.32f, {-1.05f, 0.74f}, 0.7f, {0.70f, 0.64f, 0.56f}, 0, 0},
    {"gear", 0.50f, {0.05f, -0.62f}, 0.2f, {0.66f, 0.68f, 0.72f}, 0.4f, 4},
    {"bunny", 0.60f, {-0.75f, -0.70f}, 0.4f, {0.72f, 0.70f, 0.68f}, 0, 0},
};

Result<void> addKnot(DemoScene& scene, const SceneOptions& options)
{
    Result<AssetHandle> knot = loadMesh(scene, options, "torus_knot"); // floats and turns
    if (!knot)
        return knot.error();
    scene.world.create(Transform{.scale = scaleTo(scene.assets.mesh(*knot), 0.48f)},
                       MeshInstance{*knot}, ShadowFieldOccluder{*knot},
                       Material{vec3(0.70f, 0.66f, 0.62f), 0, 0},
                       Orbit{.center = vec3(0.05f, 0.52f, 0.12f), .spin = 0.8f});
    return {};
}

const Material kMatte{vec3(0.5f), 0, 0};

// The surface blocks the light of others as the solid does that it covers.
Result<void> addLight(DemoScene& scene, const SceneOptions& options, const std::string& light,
                      const std::string& solid, vec3 intensity, const Orbit& orbit)
{
    Result<AssetHandle> source = loadMesh(scene, options, light);
    Result<AssetHandle> body = loadMesh(scene, options, solid);
    if (!source || !body)
        return source ? body.error() : source.error();
    scene.world.create(orbitAt(orbit, Transform{}, 0), MeshInstance{*source},
                       ShadowFieldEmitter{*source, intensity}, ShadowFieldOccluder{*body}, kMatte,
                       orbit);
    return {};
}

} // namespace

Result<std::unique_ptr<DemoScene>> loadLightsScene(const SceneOptions& options)
{
    Result<std::unique_ptr<DemoScene>> made = makeFloorScene(options, "lights", "courtyard", 0.12f);
    if (!made)
        return made;
    std::unique_ptr<DemoScene> scene = std::move(*made);
    scene->camera = {.target = vec3(0, 0.28f, 0),
                     .distance = 4.4f,
                     .yaw = 0.45f,
                     .pitch = 0.55f,
                     .fieldOfView = 0.62f};

    constexpr float kHalfTurn = glm::pi<float>();
    Result<void> done = placeObjects(*scene, options, kObjects);
    if (done)
        done = addKnot(*scene, options);
    if (done)
        done = addLight(*scene, options, "ball_lamp", "ball", vec3(10, 4.5f, 1.8f),
                        {.center = vec3(0, 0.62f, 0), .radius = 1.15f, .speed = 0.7f, .bob = 0.2f});
    if (done)
        done = addLight(*scene, options, "ball_lamp", "ball", vec3(1.8f, 4.2f, 10),
                        {.center = vec3(0, 0.80f, 0),
                         .radius = 0.55f,
                         .speed = -0.9f,
                         .phase = kHalfTurn,
                         .bob = 0.15f});
    const Orbit picture{.center = vec3(0, 0.75f, 0),
                        .radius = 1.7f,
                        .speed = 0.12f,
                        .phase = 1.31f * kHalfTurn, // its back to the camera at first
                        .aim = 1};
    if (done)
        done = addLight(*scene, options, "picture_lamp", "panel", vec3(6), picture);
    Result<AssetHandle> back = loadMesh(*scene, options, "panel"); // what is behind the picture
    if (!done || !back)
        return done ? back.error() : done.error();
    scene->world.create(orbitAt(picture, Transform{}, 0), MeshInstance{*back}, kMatte, picture);
    return scene;
}

} // namespace penumbra
