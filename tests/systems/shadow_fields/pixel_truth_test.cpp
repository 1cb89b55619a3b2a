// A floor of two triangles under objects, against ray-traced truth at the same points: what pixel
// receivers are for.
#include "demo/reference/reference.h"
#include "tests/systems/shadow_fields/pixel_scene.h"

namespace penumbra {
namespace {

constexpr std::uint32_t kFloor = 3; // instance

// Three spheres over a plate of 6 m whose sides have `cells` quads.
TestScene makeFloorScene(int cells)
{
    TestScene scene;
    scene.assets.push_back(makeSphereAsset(0.5f, 16));
    scene.assets.push_back(makeBoxAsset(vec3(3, 0.1f, 3), cells, false));
    std::vector<SceneInstance> instances;
    for (int i = 0; i < 3; ++i)
        instances.push_back({.mesh = 0,
                             .position = vec3(static_cast<float>(i) - 1, 0.55f, 0.3f),
                             .scale = 0.7f,
                             .material = {vec3(0.6f), 0, 0},
                             .occluder = 0u});
    instances.push_back({.mesh = 1, .position = vec3(0, -0.1f, 0), .material = {vec3(0.7f), 0, 0}});
    std::vector<const MeshAsset*> meshes;
    for (const MeshAsset& mesh : scene.assets)
        meshes.push_back(&mesh);
    scene.data = buildSceneData(meshes, std::move(instances));
    scene.environment = makeTestScene().environment;
    scene.view =
        viewOf({.target = vec3(0, 0.3f, 0), .distance = 4, .yaw = 0.4f, .pitch = 0.6f}, 4.0f / 3);
    scene.constants = frameConstants(scene.view, environmentLight(scene.environment, 1), 1);
    return scene;
}

// Truth at every 5th pixel of the floor.
struct FloorTruth {
    std::vector<std::size_t> pixels;
    ReferenceRadiance radiance;

    FloorTruth(const TestScene& scene, const DrawnPixels& drawn)
    {
        const CpuInstances rows = updateInstances(scene.data);
        std::vector<ReferenceInstance> instances;
        std::vector<MeshMaterial> materials;
        for (std::uint32_t i = 0; i < scene.data.instances.size(); ++i) {
            const GpuInstance& g = rows.instances[i];
            instances.push_back({&scene.assets[scene.data.instances[i].mesh],
                                 glm::transpose(mat4(g.worldFromObject0, g.worldFromObject1,
                                                     g.worldFromObject2, vec4(0, 0, 0, 1))),
                                 i});
            materials.push_back(scene.data.instances[i].material);
        }
        std::vector<ReferenceReceiver> receivers;
        for (std::size_t i = 0; i < drawn.slots.size(); i += 5) {
            if (!drawn.shows(i, kFloor))
                continue;
            const Receiver r = makeReceiver(rows.instances[kFloor],
                                            drawn.gbuffer.receivers[i].geometry, scene.view.eye);
            if (r.normal.y < 0.9f)
                continue; // a side of the plate
            receivers.push_back({r.position, normalize(r.normal),
                                 normalize(scene.view.eye - r.position), kFloor, kFloor});
            pixels.push_back(i);
        }
        const Result<ReferenceScene> traced = ReferenceScene::build(instances, materials);
        if (!traced)
            throw std::runtime_error(traced.error().message);
        radiance = shadeReference(*traced, ReferenceLight::fromMap(scene.environment), receivers,
                                  {.samples = 256});
    }

    [[nodiscard]] double error(const DrawnPixels& drawn) const
    {
        std::vector<vec3> test;
        for (const std::size_t i : pixels)
            test.push_back(drawn.radiance[i]);
        return compareRadiance(test, radiance.shadowed, radiance.unshadowed).rmseRelative;
    }
};

TEST_F(PixelTest, TwoTrianglesShowTheShadowsOfADenseFloor)
{
    const TestScene dense = makeFloorScene(60), coarse = makeFloorScene(1);
    const DrawnPixels pixels = draw(coarse, {});
    const FloorTruth truth(coarse, pixels);
    ASSERT_GT(truth.pixels.size(), 1000u);
    const double denseVertices = truth.error(draw(dense, {.rate = 0}));
    const double coarsePixels = truth.error(pixels);
    const double coarseHalf = truth.error(draw(coarse, {.rate = 2}));
    const double coarseVertices = truth.error(draw(coarse, {.rate = 0}));
    EXPECT_LT(coarsePixels, 1.05 * denseVertices);
    EXPECT_LT(coarseHalf, 1.05 * denseVertices);
    EXPECT_GT(coarseVertices, 3 * denseVertices);
    RecordProperty("denseVertices", std::to_string(denseVertices));
    RecordProperty("coarsePixels", std::to_string(coarsePixels));
    RecordProperty("coarseHalf", std::to_string(coarseHalf));
    RecordProperty("coarseVertices", std::to_string(coarseVertices));
}

} // namespace
} // namespace penumbra
