#include "demo/scenes/materials.h"

#include "demo/gloss_cycle.h"
#include "demo/orbit.h"
#include "demo/scenes/objects.h"
#include "systems/rotation.h"

#include <glm/gtc/constants.hpp>

namespace penumbra {

namespace {

constexpr int kColumns = 6; // exponents 2, 4, … 64
constexpr float kPitch = 0.46f;
constexpr vec3 kCopper(0.72f, 0.42f, 0.26f), kJade(0.22f, 0.46f, 0.36f);

// In the front row each ball keeps its exponent; in the row behind it each goes through all of
// them, one after the other.
void placeBalls(DemoScene& scene, AssetHandle ball)
{
    for (int i = 0; i < kColumns; ++i) {
        const float x = (static_cast<float>(i) - 0.5f * (kColumns - 1)) * kPitch;
        scene.world.create(Transform{vec3(x, 0.18f, 0.62f)}, MeshInstance{ball},
                           ShadowFieldOccluder{ball},
                           Material{kCopper, 0.55f, static_cast<float>(2 << i)});
        const GlossCycle cycle{.phase = static_cast<float>(i) / kColumns};
        scene.world.create(Transform{vec3(x, 0.18f, 0.12f)}, MeshInstance{ball},
                           ShadowFieldOccluder{ball}, Material{kJade, 0.55f, exponentAt(cycle, 0)},
                           cycle);
    }
}

} // namespace

Result<std::unique_ptr<DemoScene>> loadMaterialsScene(const SceneOptions& options)
{
    Result<std::unique_ptr<DemoScene>> made = makeFloorScene(options, "materials", "courtyard");
    if (!made)
        return made;
    std::unique_ptr<DemoScene> scene = std::move(*made);
    scene->camera = {.target = vec3(0, 0.2f, -0.05f),
                     .distance = 4.0f,
                     .yaw = 0.35f,
                     .pitch = 0.42f,
                     .fieldOfView = 0.62f,
                     .exposure = 1.2f};
    Result<AssetHandle> ball = loadMesh(*scene, options, "ball");
    Result<AssetHandle> beachBall = loadMesh(*scene, options, "beach_ball");
    Result<AssetHandle> knot = loadMesh(*scene, options, "painted_knot");
    for (const Result<AssetHandle>* asset : {&ball, &beachBall, &knot})
        if (!*asset)
            return asset->error();
    placeBalls(*scene, *ball);
    // The ball has no Material: all it shows is the asset's. The knot's is white and leaves its
    // colours, but adds a gloss.
    const quat tilt = glm::angleAxis(0.5f, normalize(vec3(1, 0, 0.6f)));
    constexpr float kScale = 1.6f;
    scene->world.create(Transform{vec3(-0.62f, kScale * 0.18f, -0.5f), kScale, toVec4(tilt)},
                        MeshInstance{*beachBall}, ShadowFieldOccluder{*beachBall});
    scene->world.create(Transform{.scale = 1.3f}, MeshInstance{*knot}, ShadowFieldOccluder{*knot},
                        Material{vec3(1), 0.5f, 6},
                        Orbit{.center = vec3(0.62f, 0.42f, -0.5f), .spin = 0.7f});
    return scene;
}

} // namespace penumbra
