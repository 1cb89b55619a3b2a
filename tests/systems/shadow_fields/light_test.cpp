// Local lights by the CPU twin of the kernels: energy, order and what must not jump.
#include "shaders/shared/order.h"

#include "systems/rotation.h"
#include "tests/systems/shadow_fields/test_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/gtc/constants.hpp>

namespace penumbra {
namespace {

SceneData build(const std::vector<MeshAsset>& assets, std::vector<SceneInstance> instances,
                std::vector<SceneLight> lights)
{
    std::vector<const MeshAsset*> meshes;
    for (const MeshAsset& asset : assets)
        meshes.push_back(&asset);
    return buildSceneData(meshes, std::move(instances), std::move(lights));
}

LightSh uniformLight(float radiance)
{
    LightSh light{};
    light[0] = vec3(radiance * kSqrt4Pi);
    return light;
}

constexpr Kernel kKernels[] = {Kernel::Literal, Kernel::Exact};

// Of the first `count` receivers: the radiance of channel 0.
std::pair<float, float> range(std::span<const vec4> radiance, std::size_t count)
{
    const auto [low, high] =
        std::minmax_element(radiance.begin(), radiance.begin() + static_cast<std::ptrdiff_t>(count),
                            [](const vec4& a, const vec4& b) { return a.x < b.x; });
    return {low->x, high->x};
}

TEST(Energy, AUniformSkyGivesTheAlbedoAtAnyRotation)
{
    const std::vector<MeshAsset> assets = {makeSphereAsset(0.4f, 12, false)};
    for (const float angle : {0.0f, 0.7f, 2.9f}) {
        const SceneData scene =
            build(assets,
                  {{.rotation = toVec4(glm::angleAxis(angle, normalize(vec3(1, 2, 3)))),
                    .material = {vec3(0.37f), 0, 0}}},
                  {});
        for (const Kernel kernel : kKernels) {
            const auto [low, high] = range(
                shadeAll(kernel, scene, frameConstants({}, uniformLight(1), 1)), scene.vertexCount);
            EXPECT_NEAR(low, 0.37f, 0.005f * 0.37f) << kernelName(kernel);
            EXPECT_NEAR(high, 0.37f, 0.005f * 0.37f) << kernelName(kernel);
        }
    }
}

// Six rectangles of radiance 1 close a cube around the receivers: the same as a uniform sky.
TEST(Energy, ABoxOfRectanglesGivesTheAlbedo)
{
    const std::vector<MeshAsset> assets = {makeSphereAsset(0.1f, 8, false),
                                           makeRectangleLight(vec2(2), vec3(1))};
    std::vector<SceneLight> lights;
    for (int side = 0; side < 6; ++side) {
        vec3 outwards(0);
        outwards[side / 2] = side % 2 == 0 ? 1.0f : -1.0f;
        // Flat lights emit along +z: turn that inwards.
        const vec3 axis = side / 2 == 2 ? vec3(1, 0, 0) : cross(vec3(0, 0, 1), -outwards);
        const quat turn = glm::angleAxis(std::acos(-outwards.z), axis);
        lights.push_back({.asset = 1, .position = outwards, .rotation = toVec4(turn)});
    }
    const SceneData scene = build(assets, {{.material = {vec3(0.5f), 0, 0}}}, lights);
    for (const Kernel kernel : kKernels) {
        const auto [low, high] =
            range(shadeAll(kernel, scene, frameConstants({}, LightSh{}, 0)), scene.vertexCount);
        EXPECT_NEAR(low, 0.5f, 0.03f * 0.5f) << kernelName(kernel);
        EXPECT_NEAR(high, 0.5f, 0.03f * 0.5f) << kernelName(kernel);
    }
}

// Mean radiance, and the changes between two pictures.
struct Change {
    double mean = 0, largest = 0, rms = 0;
};

Change changeOf(const std::vector<vec4>& a, const std::vector<vec4>& b)
{
    Change change;
    for (std::size_t i = 0; i < a.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            change.mean += a[i][c] / (3.0 * static_cast<double>(a.size()));
            const double difference = static_cast<double>(a[i][c]) - b[i][c];
            change.largest = std::max(change.largest, std::abs(difference));
            change.rms += difference * difference / (3.0 * static_cast<double>(a.size()));
        }
    change.rms = std::sqrt(change.rms);
    return change;
}

// The whole scene turned: objects, lights, sky and eye. Kernel literal truncates each product to
// order 4, which rotations keep. What kernel exact makes of products of a higher degree than its
// nodes resolve depends on where these lie, and they turn with the receiver.
TEST(Invariance, RotatingTheWholeSceneChangesNothing)
{
    const TestScene upright = makeLitTestScene();
    const quat turn = glm::angleAxis(1.1f, normalize(vec3(1, -2, 0.5f)));
    const mat3 matrix = glm::mat3_cast(turn);
    TestScene turned = upright;
    const auto rotateAll = [&](auto& entities) {
        for (auto& e : entities) {
            e.position = matrix * e.position;
            e.rotation = toVec4(turn * toQuat(e.rotation));
        }
    };
    rotateAll(turned.data.instances);
    rotateAll(turned.data.lights);
    turned.constants = frameConstants(
        upright.view, rotatedLight(environmentLight(upright.environment, 1), matrix), 1);
    turned.constants.eye = vec4(matrix * vec3(upright.constants.eye), 1);
    for (const Kernel kernel : kKernels) {
        const Change change = changeOf(shadeAll(kernel, upright.data, upright.constants),
                                       shadeAll(kernel, turned.data, turned.constants));
        EXPECT_LT(change.largest, 0.001 * change.mean) << kernelName(kernel);
        RecordProperty(std::string(kernelName(kernel)) + "Rms",
                       std::to_string(change.rms / change.mean));
        RecordProperty(std::string(kernelName(kernel)) + "Largest",
                       std::to_string(change.largest / change.mean));
    }
}

TEST(Invariance, TheOrderOfTwoDisjointOccludersHardlyMatters)
{
    const std::vector<MeshAsset> assets = {makeBoxAsset(vec3(1, 0.05f, 1), 12, false),
                                           makeSphereAsset(0.25f, 12)};
    const SceneData scene = build(assets,
                                  {{.mesh = 0, .position = vec3(0, -0.05f, 0)},
                                   {.mesh = 1, .position = vec3(-0.2f, 0.3f, 0), .occluder = 1},
                                   {.mesh = 1, .position = vec3(0.3f, 0.6f, 0), .occluder = 1}},
                                  {});
    LightSh sky = uniformLight(1);
    sky[1] = sky[2] = sky[3] = vec3(0.8f);
    const FrameConstants frame = frameConstants({}, sky, 1);
    const CpuInstances rows = updateInstances(scene);
    const std::uint32_t first = listEntry(1, 1), second = listEntry(2, 1);
    for (const Kernel kernel : kKernels) {
        std::vector<vec4> near(scene.radianceCount), far(scene.radianceCount);
        for (std::uint32_t c = 0; scene.clusters[c].instance == 0; ++c) {
            combineCluster(kernel, scene, rows, frame, {c, {first, second}, {}, {0, 0}, {}}, near);
            combineCluster(kernel, scene, rows, frame, {c, {second, first}, {}, {0, 0}, {}}, far);
        }
        near.resize(scene.firstRadiance[1]);
        far.resize(scene.firstRadiance[1]);
        const float brightest = range(near, near.size()).second;
        EXPECT_GT(brightest, 0.5f);
        EXPECT_LT(changeOf(near, far).largest, 0.01 * brightest) << kernelName(kernel);
        RecordProperty(std::string(kernelName(kernel)),
                       std::to_string(changeOf(near, far).largest / brightest));
    }
}

// Weights of one occluder and one light, as entity_sort and the kernels ask for them.
TEST(Order, FollowsWhatARayMeetsFirst)
{
    const vec4 table(0, 0, 0, 1), lamp(0, 0.3f, 0, 0.1f); // the lamp stands on it
    EXPECT_EQ(orderWeight(table, lamp, vec3(0, 1.5f, 0)), 0);
    EXPECT_EQ(orderWeight(table, lamp, vec3(0, -1.5f, 0)), 1);
    const vec4 ball(0, 0, 0.3f, 0.23f), screen(0, 0, 0, 0.57f); // the ball stands before the screen
    EXPECT_EQ(orderWeight(ball, screen, vec3(0, 0, 1)), 1);
    EXPECT_EQ(orderWeight(ball, screen, vec3(0, 0, -1)), 0);
    EXPECT_EQ(orderWeight(ball, vec4(ball.x, ball.y, ball.z, 0.1f), vec3(1, 2, 3)), 0.5f);
}

TEST(Order, TurnsAsSmoothlyFarAwayAsNearby)
{
    const vec4 occluder(0, 0, 0, 0.25f);
    for (const float distance : {0.5f, 3.0f, 30.0f}) {
        float largest = 0;
        for (int i = -400; i < 400; ++i) { // the light passes in steps of a millimetre
            const auto weight = [&](int step) {
                const vec4 light(0.45f, 0.001f * static_cast<float>(step), 0, 0.1f);
                return orderWeight(occluder, light, vec3(0.22f, distance, 0));
            };
            largest = std::max(largest, std::abs(weight(i + 1) - weight(i)));
        }
        EXPECT_LT(largest, 0.04f) << distance;
    }
}

TEST(Order, AClusterAgreesWithItsPoints)
{
    const vec4 occluder(0.1f, 0, 0, 0.3f), light(0.6f, 0.2f, 0, 0.15f);
    int certain = 0;
    for (int i = 0; i < 2000; ++i) {
        const auto f = static_cast<float>(i);
        const vec3 center(3 * std::sin(f), 2 * std::sin(1.3f * f + 1), std::sin(2.7f * f));
        const float around = orderWeightAround(occluder, light, center, 0.2f);
        const vec3 offset = 0.2f * normalize(vec3(std::sin(5 * f), std::cos(3 * f), std::sin(f)));
        if (around == 0.5f)
            continue;
        ++certain;
        EXPECT_EQ(orderWeight(occluder, light, center + offset), around);
    }
    EXPECT_GT(certain, 500);
}

// A light flies past and through an object over a floor, in steps of a millimetre: it changes
// places with the object in the order of the floor's receivers, and enters its bounding sphere.
class FlyingLight : public ::testing::TestWithParam<Kernel> {
protected:
    // Largest change of a receiver of the floor within a step, over the brightest receiver.
    double largestStep(vec3 from, vec3 to)
    {
        const std::vector<MeshAsset> assets = {makeBoxAsset(vec3(1, 0.05f, 1), 12, false),
                                               makeSphereAsset(0.25f, 12),
                                               makeSphereLight(0.1f, vec3(10))};
        SceneInstance floor{.mesh = 0, .position = vec3(0, -0.05f, 0)};
        SceneInstance ball{.mesh = 1, .position = vec3(0, 0.4f, 0), .occluder = 1};
        const auto steps = static_cast<int>(length(to - from) / 0.001f);
        double largest = 0;
        std::vector<vec4> last;
        for (int i = 0; i <= steps; ++i) {
            const vec3 at = from + 0.001f * static_cast<float>(i) * normalize(to - from);
            const SceneData scene = build(assets, {floor, ball}, {{.asset = 2, .position = at}});
            std::vector<vec4> now = shadeAll(GetParam(), scene, frameConstants({}, LightSh{}, 0));
            now.resize(scene.firstRadiance[1]); // the floor
            if (!last.empty()) {
                const Change change = changeOf(now, last);
                const float brightest = range(now, now.size()).second;
                EXPECT_GT(brightest, 0.05f);
                largest = std::max(largest, change.largest / brightest);
            }
            last = std::move(now);
        }
        return largest;
    }
};

TEST_P(FlyingLight, PassesTheObjectWithoutAJump)
{
    EXPECT_LT(largestStep(vec3(0.45f, 0.3f, 0), vec3(0.45f, 0.6f, 0)), 0.01);
}

TEST_P(FlyingLight, FliesThroughTheObjectWithoutAJump)
{
    EXPECT_LT(largestStep(vec3(0.5f, 0.45f, 0), vec3(-0.5f, 0.45f, 0)), 0.02);
}

// More entities than a cluster's list holds, over a floor that is one cluster on top: one of them
// comes in from afar, step by step of a millimetre, and takes another one's place.
class Crowd : public ::testing::TestWithParam<Kernel> {
protected:
    static constexpr float kFrom = 0.9f, kTo = 0.5f; // of the one that moves, from the middle

    // Largest change of a receiver within a step, over the brightest receiver. place(at, instances,
    // lights, sky) fills the scene, with one entity at `at`.
    template <class Place>
    double largestStep(const std::vector<MeshAsset>& assets, const Place& place)
    {
        constexpr int kSteps = 400;
        double largest = 0;
        int listedAtFirst = 0;
        std::vector<vec4> last;
        for (int i = 0; i <= kSteps; ++i) {
            const float distance = kFrom + (kTo - kFrom) * static_cast<float>(i) / kSteps;
            std::vector<SceneInstance> instances = {{.mesh = 0, .position = vec3(0, -0.05f, 0)}};
            std::vector<SceneLight> lights;
            LightSh sky{};
            place(vec3(distance, 0.12f, 0.02f), instances, lights, sky);
            const SceneData scene = build(assets, instances, lights);
            std::vector<vec4> now = shadeAll(GetParam(), scene, frameConstants({}, sky, 1));
            now.resize(scene.firstRadiance[1]); // the floor
            const float brightest = range(now, now.size()).second;
            EXPECT_GT(brightest, 0.1f);
            if (!last.empty())
                largest = std::max(largest, changeOf(now, last).largest / brightest);
            last = std::move(now);
            if (i == 0)
                listedAtFirst = listings(scene, movingRow(scene));
            if (i == kSteps) {
                EXPECT_GT(listings(scene, movingRow(scene)), listedAtFirst);
            }
        }
        return largest;
    }
    // Clusters of the floor in whose list a row has a share.
    static int listings(const SceneData& scene, std::uint32_t row)
    {
        int count = 0;
        for (const ClusterEntities& cluster : sortAll(scene, updateInstances(scene))) {
            if (scene.clusters[cluster.cluster].instance != 0)
                continue;
            for (const std::uint32_t entry : cluster.occluders)
                count += entryRow(entry) == row && entryShare(entry) > 0;
            for (const ClusterLight& light : cluster.lights)
                count += entryRow(light.entry) == row && entryShare(light.entry) > 0;
        }
        return count;
    }
    // The first light, or the first instance after the floor.
    static std::uint32_t movingRow(const SceneData& scene)
    {
        return scene.lights.empty() ? 1 : static_cast<std::uint32_t>(scene.instances.size());
    }
    // Where the others lie: a spiral, so that no two are equally far away.
    static vec3 spiral(int i)
    {
        const float angle = 2.4f * static_cast<float>(i),
                    radius = 0.3f + 0.015f * static_cast<float>(i);
        return vec3(radius * std::cos(angle), 0.12f, radius * std::sin(angle));
    }
};

TEST_P(Crowd, OccludersTakePlacesWithoutAJump)
{
    const std::vector<MeshAsset> assets = {makeBoxAsset(vec3(1, 0.05f, 1), 4, false),
                                           makeSphereAsset(0.1f, 8)};
    const double step = largestStep(assets, [](vec3 moving, auto& instances, auto&, LightSh& sky) {
        sky = uniformLight(1);
        instances.push_back({.mesh = 1, .position = moving, .occluder = 1});
        for (int i = 0; i < 40; ++i)
            instances.push_back({.mesh = 1, .position = spiral(i), .occluder = 1});
    });
    EXPECT_LT(step, 0.01);
    RecordProperty("step", std::to_string(step));
}

TEST_P(Crowd, LightsTakePlacesWithoutAJump)
{
    const std::vector<MeshAsset> assets = {makeBoxAsset(vec3(1, 0.05f, 1), 4, false),
                                           makeSphereAsset(0.1f, 8),
                                           makeSphereLight(0.1f, vec3(10))};
    const double step =
        largestStep(assets, [](vec3 moving, auto& instances, auto& lights, LightSh&) {
            instances.push_back({.mesh = 1, .position = vec3(0, 3, 0)});
            lights.push_back({.asset = 2, .position = moving});
            for (int i = 0; i < 24; ++i)
                lights.push_back({.asset = 2, .position = spiral(i)});
        });
    EXPECT_LT(step, 0.03);
    RecordProperty("step", std::to_string(step));
}

// What a light counts for goes by its field's radiance too, not only by the factor of its instance.
TEST(Lists, KeepABrightLampAmongManyDimOnes)
{
    const std::vector<MeshAsset> assets = {makeBoxAsset(vec3(1, 0.05f, 1), 4, false),
                                           makeSphereLight(0.1f, vec3(1)),
                                           makeSphereLight(0.1f, vec3(100))};
    std::vector<SceneLight> lights = {{.asset = 2, .position = vec3(0, 1.5f, 0)}};
    for (int i = 0; i < 30; ++i)
        lights.push_back(
            {.asset = 1, .position = vec3(0.05f * static_cast<float>(i - 15), 0.5f, 0)});
    const SceneData scene = build(assets, {{.mesh = 0, .position = vec3(0, -0.05f, 0)}}, lights);
    int full = 0;
    for (const ClusterEntities& cluster : sortAll(scene, updateInstances(scene))) {
        if (cluster.lights.size() < kMaxClusterLights)
            continue;
        ++full;
        EXPECT_TRUE(std::any_of(cluster.lights.begin(), cluster.lights.end(),
                                [](auto& light) { return light.entry == listEntry(1, 1); }));
    }
    EXPECT_GT(full, 0);
}

INSTANTIATE_TEST_SUITE_P(Kernels, Crowd, ::testing::ValuesIn(kKernels),
                         [](const auto& test) { return std::string(kernelName(test.param)); });

INSTANTIATE_TEST_SUITE_P(Kernels, FlyingLight, ::testing::ValuesIn(kKernels),
                         [](const auto& test) { return std::string(kernelName(test.param)); });

} // namespace
} // namespace penumbra
