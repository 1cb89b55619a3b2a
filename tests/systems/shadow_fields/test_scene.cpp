#include "tests/systems/shadow_fields/test_scene.h"

#include "assetc/bake.h"
#include "assetc/light/flat_emitter.h"
#include "assetc/light/light_field.h"
#include "assetc/light/shape_mesh.h"
#include "assetc/light/sphere_emitter.h"
#include "shaders/shared/environment.h"
#include "systems/rotation.h"

#include <glm/gtc/constants.hpp>

namespace penumbra {

namespace {

const BakeOptions kSmallField{.shells = 12, .side = 17, .directions = 256, .rasterSide = 128};

MeshAsset finish(MeshAsset mesh, bool bake, const BakeOptions& options = kSmallField)
{
    mesh.clusters = buildClusters(mesh.positions, mesh.normals, mesh.indices);
    mesh.selfVisibility.assign(mesh.positions.size(), SelfVisibility{});
    for (SelfVisibility& open : mesh.selfVisibility)
        open.fill(128);
    if (bake) {
        Progress progress("test");
        BakeResult baked = bakeMesh(mesh.positions, mesh.normals, mesh.indices, options, progress);
        mesh.selfVisibility = std::move(baked.selfVisibility);
        mesh.field = quantiseField(baked.field);
    }
    return mesh;
}

MeshAsset makeLight(const Emitter& emitter, float innerRadius, MeshAsset mesh, vec3 radiance)
{
    mesh = finish(std::move(mesh), false);
    Progress progress("test");
    mesh.field = quantiseField(bakeLightField(
        emitter, {.shells = 14, .side = 17, .innerRadius = innerRadius, .outerRadius = 16},
        progress));
    mesh.materials.resize(1);
    mesh.materials[0].emissive = radiance;
    return mesh;
}

vec4 quaternion(float angle, vec3 axis)
{
    return toVec4(glm::angleAxis(angle, normalize(axis)));
}

} // namespace

namespace {

MeshAsset makeSphereMesh(float radius, int rows)
{
    MeshAsset mesh;
    const int turns = 2 * rows;
    for (int i = 0; i <= rows; ++i) {
        for (int j = 0; j <= turns; ++j) {
            const float a = glm::pi<float>() * static_cast<float>(i) / static_cast<float>(rows);
            const float b =
                2 * glm::pi<float>() * static_cast<float>(j) / static_cast<float>(turns);
            mesh.normals.push_back(
                vec3(std::sin(a) * std::cos(b), std::cos(a), std::sin(a) * std::sin(b)));
            mesh.positions.push_back(radius * mesh.normals.back());
        }
    }
    for (int i = 0; i < rows; ++i) {
        for (int j = 0; j < turns; ++j) {
            const auto a = static_cast<std::uint32_t>(i * (turns + 1) + j),
                       b = a + static_cast<std::uint32_t>(turns) + 1;
            if (i > 0)
                mesh.indices.insert(mesh.indices.end(), {a, a + 1, b + 1});
            if (i < rows - 1)
                mesh.indices.insert(mesh.indices.end(), {a, b + 1, b});
        }
    }
    return mesh;
}

} // namespace

MeshAsset makeSphereAsset(float radius, int rows, bool bake)
{
    return finish(makeSphereMesh(radius, rows), bake);
}

MeshAsset makeFineSphereAsset(float radius)
{
    return finish(makeSphereMesh(radius, 48), true, {});
}

MeshAsset makeBoxAsset(vec3 halfExtents, int cells, bool bake)
{
    MeshAsset mesh;
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2;
        vec3 normal(0), u(0), v(0);
        normal[axis] = face % 2 == 0 ? 1.0f : -1.0f;
        u[(axis + 1) % 3] = 1;
        v = cross(normal, u);
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (int y = 0; y <= cells; ++y) {
            for (int x = 0; x <= cells; ++x) {
                const float s = 2 * static_cast<float>(x) / static_cast<float>(cells) - 1;
                const float t = 2 * static_cast<float>(y) / static_cast<float>(cells) - 1;
                mesh.positions.push_back(halfExtents * (normal + s * u + t * v));
                mesh.normals.push_back(normal);
            }
        }
        const auto stride = static_cast<std::uint32_t>(cells + 1);
        for (std::uint32_t y = 0; y + 1 < stride; ++y) {
            for (std::uint32_t x = 0; x + 1 < stride; ++x) {
                const std::uint32_t a = first + y * stride + x;
                mesh.indices.insert(mesh.indices.end(),
                                    {a, a + 1, a + stride + 1, a, a + stride + 1, a + stride});
            }
        }
    }
    return finish(std::move(mesh), bake);
}

MeshAsset makeSphereLight(float radius, vec3 radiance)
{
    return makeLight(SphereEmitter(radius, radiance), 1,
                     makeShapeMesh({.shape = EmitterShape::Sphere, .radius = radius}), radiance);
}

MeshAsset makeRectangleLight(vec2 size, vec3 radiance)
{
    const LightSpec spec{.shape = EmitterShape::Rectangle, .emission = radiance, .size = size};
    return makeLight(*FlatEmitter::make(spec, nullptr), 0.4f, makeShapeMesh(spec), radiance);
}

namespace {

// From scene.assets, a sky and a camera.
void assemble(TestScene& scene, std::vector<SceneInstance> instances,
              std::vector<SceneLight> lights)
{
    const std::uint32_t width = 32, height = 16;
    std::vector<vec3> map;
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const vec3 d =
                equirectDirection(vec2(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f) /
                                  vec2(width, height));
            map.push_back(vec3(0.3f) + std::max(0.0f, dot(d, normalize(vec3(1, 2, 0.5f)))) *
                                           vec3(2.0f, 1.6f, 1.2f));
        }
    scene.environment = makeEnvironment(width, height, std::move(map));

    std::vector<const MeshAsset*> meshes;
    for (const MeshAsset& mesh : scene.assets)
        meshes.push_back(&mesh);
    scene.data = buildSceneData(meshes, std::move(instances), std::move(lights));
    scene.view =
        viewOf({.target = vec3(0, 0.5f, 0), .distance = 5, .yaw = 0.4f, .pitch = 0.5f}, 4.0f / 3);
    scene.constants = frameConstants(scene.view, environmentLight(scene.environment, 1), 1);
}

// `crowd`: small spheres, and half as many lights, among the objects.
TestScene makeScene(bool lit, int crowd = 0)
{
    TestScene scene;
    scene.assets.push_back(makeSphereAsset(0.5f, 16));
    scene.assets.push_back(makeBoxAsset(vec3(0.3f, 0.4f, 0.5f), 6));
    scene.assets.push_back(makeBoxAsset(vec3(3, 0.1f, 3), 20, false));

    std::vector<SceneInstance> instances;
    for (int i = 0; i < 9; ++i) {
        const auto f = static_cast<float>(i);
        SceneInstance instance;
        instance.mesh = static_cast<std::uint32_t>(i % 2);
        instance.occluder = instance.mesh;
        instance.position =
            vec3(1.5f * std::cos(2.1f * f), 0.5f + 0.12f * f, 1.4f * std::sin(2.1f * f));
        instance.scale = 0.6f + 0.08f * f;
        instance.rotation = quaternion(0.9f * f, vec3(1, f, 2));
        instance.material = {vec3(0.8f, 0.5f + 0.04f * f, 0.3f), i % 3 == 0 ? 0.5f : 0.0f, 6};
        instances.push_back(instance);
    }
    instances.push_back({.mesh = 2, .position = vec3(0, -0.1f, 0), .material = {vec3(0.7f), 0, 0}});

    std::vector<SceneLight> lights;
    if (lit) {
        scene.assets.push_back(makeSphereLight(0.15f, vec3(20, 16, 10)));
        scene.assets.push_back(makeRectangleLight(vec2(0.6f, 0.4f), vec3(3, 8, 20)));
        lights.push_back({.asset = 3, .position = vec3(0.2f, 1.1f, 0.1f)});
        lights.push_back({.asset = 3,
                          .position = instances[4].position + vec3(0.3f, 0.2f, 0),
                          .scale = 0.7f,
                          .intensity = vec3(0.4f, 1, 0.6f)});
        const vec4 facing = quaternion(1.8f, vec3(1, 0.3f, 0));
        const vec3 above(-0.8f, 1.9f, 0.4f);
        lights.push_back({.asset = 4,
                          .position = above,
                          .rotation = facing,
                          .owner = static_cast<std::uint32_t>(instances.size())});
        instances.push_back({.mesh = 4,
                             .position = above,
                             .rotation = facing,
                             .material = {vec3(0.5f), 0, 0},
                             .emission = vec3(1)});
    }
    for (int i = 0; i < crowd; ++i) {
        const float angle = 2.4f * static_cast<float>(i),
                    radius = 0.4f + 0.04f * static_cast<float>(i);
        const vec3 at(radius * std::cos(angle), 0.3f, radius * std::sin(angle));
        instances.push_back({.mesh = 0, .position = at, .scale = 0.2f, .occluder = 0});
        if (i % 2 == 0)
            lights.push_back({.asset = 3, .position = at + vec3(0, 0.4f, 0), .scale = 0.3f});
    }
    assemble(scene, std::move(instances), std::move(lights));
    return scene;
}

} // namespace

TestScene makeTestScene()
{
    return makeScene(false);
}

TestScene makeLitTestScene()
{
    return makeScene(true);
}

TestScene makeCrowdedTestScene()
{
    return makeScene(true, 48);
}

TestScene makeBoulderTestScene()
{
    TestScene scene;
    scene.assets.push_back(makeSphereAsset(0.5f, 16));
    scene.assets.push_back(makeBoxAsset(vec3(0.2f), 7, false)); // a side is a cluster
    scene.assets.push_back(makeSphereLight(0.15f, vec3(20, 16, 10)));
    std::vector<SceneInstance> instances = {
        {.mesh = 0, .position = vec3(0, 0.5f, 0), .scale = 2, .occluder = 0}};
    for (int i = 0; i < 144; ++i) {
        const vec3 at(0.4f * static_cast<float>(i % 12) - 2.2f, -0.2f,
                      0.4f * static_cast<float>(i / 12) - 2.2f);
        instances.push_back({.mesh = 1, .position = at, .material = {vec3(0.7f), 0, 0}});
    }
    std::vector<SceneLight> lights;
    for (int i = 0; i < 9; ++i) {
        const float angle = 0.7f * static_cast<float>(i);
        const vec3 at(1.5f * std::cos(angle), 0.7f, 1.5f * std::sin(angle));
        instances.push_back({.mesh = 0, .position = at, .scale = 0.9f, .occluder = 0});
        if (i % 4 == 1) { // with a surface that blocks
            instances.back().scale = 0.6f;
            lights.push_back({.asset = 2,
                              .position = at,
                              .scale = 2,
                              .owner = static_cast<std::uint32_t>(instances.size() - 1)});
        }
    }
    assemble(scene, std::move(instances), std::move(lights));
    return scene;
}

std::vector<ClusterEntities> sortAll(const SceneData& data, const CpuInstances& rows)
{
    FrameConstants frame = frameConstants({}, LightSh{}, 0);
    frame.culls = kCullHorizon | kCullHidden;
    return cullAndSort(data, rows, frame);
}

std::vector<vec4> shadeAll(Kernel kernel, const SceneData& data, const FrameConstants& constants)
{
    const CpuInstances rows = updateInstances(data);
    std::vector<vec4> radiance(data.radianceCount);
    for (const ClusterEntities& cluster : sortAll(data, rows))
        combineCluster(kernel, data, rows, constants, cluster, radiance);
    return radiance;
}

} // namespace penumbra
