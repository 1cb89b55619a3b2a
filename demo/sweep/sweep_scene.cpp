#include "demo/sweep/sweep_scene.h"

#include "shaders/shared/environment.h"

#include <algorithm>
#include <glm/gtc/constants.hpp>

namespace penumbra {

namespace {

constexpr float kPi = glm::pi<float>();
constexpr float kSphereDistance = 4;   // of a sphere's middle from that of the scene, metres: the
                                       // largest leaves a metre for the objects
constexpr float kLightAzimuth = -2.0f; // radians from +Z to +X: from behind, on the camera's left
constexpr float kFloorScale = 0.35f;   // 2.8 m with vertices every 1.75 cm

struct Object {
    const char* asset;
    float size; // largest side of the bounding box, metres
    vec2 place; // x, z on the floor, metres
    float yaw;  // radians
};

// Of different shapes: thin and tall, flat, hollow, round.
constexpr Object kObjects[] = {
    {"teapot", 0.62f, {-0.45f, 0.05f}, 0.5f},       {"torus_knot", 0.45f, {0.38f, -0.35f}, 0},
    {"chess_pawn", 0.46f, {0.15f, 0.42f}, 0},       {"gear", 0.50f, {0.68f, 0.22f}, 0.2f},
    {"rounded_cube", 0.26f, {-0.32f, 0.62f}, 0.7f}, {"ball", 0.30f, {-0.15f, -0.55f}, 0},
};

float radians(float degrees)
{
    return degrees * kPi / 180;
}

// Radiance at which a disc gives the floor pi W/m².
float evenRadiance(const RoundView& view)
{
    return kPi / roundIrradiance(view, vec3(0, 1, 0));
}

} // namespace

Result<std::unique_ptr<SweepScene>> makeSweepScene(const std::filesystem::path& assets,
                                                   std::uint32_t objects, bool lamp)
{
    auto scene = std::make_unique<SweepScene>();
    const MeshMaterial matte{vec3(0.8f), 0, 0};
    Result<AssetHandle> floor = scene->assets.loadMesh(assets / "floor.glb");
    if (!floor)
        return floor.error();
    std::vector<SceneInstance> instances;
    instances.push_back({.mesh = floor->index, .scale = kFloorScale, .material = matte});
    for (const Object& object :
         std::span(kObjects).first(std::min<std::size_t>(objects, std::size(kObjects)))) {
        Result<AssetHandle> asset =
            scene->assets.loadMesh(assets / (std::string(object.asset) + ".glb"));
        if (!asset)
            return asset.error();
        const MeshAsset& mesh = scene->assets.mesh(*asset);
        const vec3 extent = mesh.boundsMax - mesh.boundsMin;
        const float scale = object.size / std::max({extent.x, extent.y, extent.z});
        instances.push_back(
            {.mesh = asset->index,
             .position = {object.place.x, -scale * mesh.boundsMin.y, object.place.y},
             .scale = scale,
             .rotation = {0, std::sin(object.yaw / 2), 0, std::cos(object.yaw / 2)},
             .material = matte,
             .occluder = asset->index});
    }
    std::vector<SceneLight> lights;
    if (lamp) {
        Result<AssetHandle> asset = scene->assets.loadMesh(assets / "ball_lamp.glb");
        if (!asset)
            return asset.error();
        scene->lamp = asset->index;
        lights.push_back(lampAs(*scene, sweepSphere(10)));
    }
    scene->data = buildSceneData(scene->assets.meshes(), std::move(instances), std::move(lights));
    scene->view = viewOf({.target = vec3(0, 0.12f, 0),
                          .distance = 4.2f,
                          .yaw = 0.35f,
                          .pitch = 0.75f,
                          .fieldOfView = 0.52f},
                         1);
    return scene;
}

vec3 sweepDirection(float elevationDegrees)
{
    const float e = radians(elevationDegrees);
    return {std::cos(e) * std::sin(kLightAzimuth), std::sin(e),
            std::cos(e) * std::cos(kLightAzimuth)};
}

RoundLight sweepCap(float halfAngleDegrees)
{
    const RoundView view{sweepDirection(kCapElevation), std::sin(radians(halfAngleDegrees))};
    return RoundLight::cap(view.axis, view.sine, evenRadiance(view));
}

RoundLight sweepSphere(float halfAngleDegrees)
{
    PENUMBRA_ASSERT(halfAngleDegrees < kSphereElevation, "a sphere of {} degrees meets the floor",
                    halfAngleDegrees);
    const RoundView view{sweepDirection(kSphereElevation), std::sin(radians(halfAngleDegrees))};
    return RoundLight::sphere(kSphereDistance * view.axis, kSphereDistance * view.sine,
                              evenRadiance(view));
}

Environment capEnvironment(float halfAngleDegrees)
{
    constexpr int kParts = 8; // of a pixel, each way
    const RoundLight light = sweepCap(halfAngleDegrees);
    const vec3 axis = light.seenFrom(vec3(0)).axis;
    const float rim = std::cos(radians(halfAngleDegrees));
    const vec2 size(kMaxEnvironmentWidth, kMaxEnvironmentHeight);
    std::vector<vec3> map;
    for (std::uint32_t y = 0; y < kMaxEnvironmentHeight; ++y)
        for (std::uint32_t x = 0; x < kMaxEnvironmentWidth; ++x) {
            // Pixels off the rim are whole; one spans at most 0.7 degrees.
            const float middle = dot(equirectDirection((vec2(x, y) + 0.5f) / size), axis);
            if (std::abs(std::acos(clamp(middle, -1.0f, 1.0f)) - radians(halfAngleDegrees)) >
                radians(1)) {
                map.emplace_back(middle >= rim ? light.radiance() : 0.0f);
                continue;
            }
            int inside = 0;
            for (int i = 0; i < kParts * kParts; ++i) {
                const vec2 part = (vec2(i % kParts, i / kParts) + 0.5f) / float(kParts);
                inside += dot(equirectDirection((vec2(x, y) + part) / size), axis) >= rim ? 1 : 0;
            }
            const float covered = static_cast<float>(inside) / float(kParts * kParts);
            map.emplace_back(covered * light.radiance());
        }
    return aboveGround(
        makeEnvironment(kMaxEnvironmentWidth, kMaxEnvironmentHeight, std::move(map)));
}

SceneLight lampAs(const SweepScene& scene, const RoundLight& light)
{
    const MeshAsset& lamp = scene.assets.mesh({*scene.lamp});
    PENUMBRA_ASSERT(lamp.field.has_value(), "{} has no field", lamp.name);
    const RoundView view = light.seenFrom(vec3(0));
    return {.asset = *scene.lamp,
            .position = kSphereDistance * view.axis,
            .scale = kSphereDistance * view.sine / lamp.field->radius,
            .intensity = vec3(light.radiance())}; // its description says radiance 1
}

} // namespace penumbra
