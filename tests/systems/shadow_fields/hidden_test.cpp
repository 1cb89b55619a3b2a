// Entities behind the inscribed ball of a nearer occluder: shaders/shared/visibility.h and the ball
// that the bake finds.
#include "assetc/bake.h"
#include "shaders/shared/visibility.h"
#include "tests/systems/shadow_fields/test_scene.h"

#include <gtest/gtest.h>
#include <random>

namespace penumbra {
namespace {

class Random {
public:
    float uniform(float low, float high)
    {
        return low + (high - low) * static_cast<float>(m_engine() >> 8) * 0x1p-24f;
    }
    vec3 inBall(vec4 ball)
    {
        for (;;) {
            const vec3 p(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
            if (dot(p, p) <= 1)
                return vec3(ball) + ball.w * p;
        }
    }
    // Before a receiver about the origin a ball, and behind the ball a sphere.
    vec4 ball() { return {uniform(-0.3f, 0.3f), uniform(1, 2), 0, uniform(0.2f, 0.9f)}; }
    vec4 sphere() { return {uniform(-1.5f, 1.5f), uniform(1, 4), 0, uniform(0.05f, 0.6f)}; }

private:
    std::mt19937 m_engine{11};
};

bool segmentMeets(vec3 from, vec3 to, vec4 ball)
{
    const vec3 d = to - from, b = vec3(ball) - from;
    const float t = clamp(dot(b, d) / dot(d, d), 0.0f, 1.0f);
    return length(b - t * d) <= ball.w * 1.0001f;
}

// The one thing that dropping relies on: no ray reaches what has no weight.
TEST(Hidden, NoRayReachesWhatHasNoWeight)
{
    Random random;
    int hidden = 0, part = 0;
    for (int i = 0; i < 20000; ++i) {
        const vec4 ball = random.ball(), sphere = random.sphere();
        const float weight = unhidden(vec3(0), ball, sphere, 1);
        part += weight > 0 && weight < 1;
        if (weight > 0)
            continue;
        ++hidden;
        for (int k = 0; k < 20; ++k)
            ASSERT_TRUE(segmentMeets(vec3(0), random.inBall(sphere), ball)) << i;
    }
    EXPECT_GT(hidden, 1000);
    EXPECT_GT(part, 500);
}

// A sphere whose centre is in sight counts whole, and so does one before or beside the ball.
TEST(Hidden, WhatIsInSightCounts)
{
    const vec4 ball(0, 2, 0, 1);
    EXPECT_EQ(unhidden(vec3(0), ball, vec4(0, 0.5f, 0, 0.2f), 1), 1); // before
    EXPECT_EQ(unhidden(vec3(0), ball, vec4(2, 2, 0, 0.2f), 1), 1);    // beside
    EXPECT_EQ(unhidden(vec3(0), ball, vec4(0, 4, 0, 4.5f), 1), 1);    // larger than the shadow
    EXPECT_EQ(unhidden(vec3(0), ball, vec4(0, -4, 0, 0.2f), 1), 1);   // on the other side
    EXPECT_EQ(unhidden(vec3(0), ball, vec4(0, 4, 0, 0.5f), 1), 0);
    EXPECT_EQ(unhidden(vec3(0), vec4(0, 2, 0, 0), vec4(0, 4, 0, 0.01f), 1), 1); // no ball
}

// One that counts in part hides in part, and from afar a ball hides less and less.
TEST(Hidden, ABallHidesAsMuchAsItsObjectCounts)
{
    const vec4 ball(0, 2, 0, 1), behind(0, 4, 0, 0.5f);
    EXPECT_EQ(unhidden(vec3(0), ball, behind, 0), 1);
    EXPECT_FLOAT_EQ(unhidden(vec3(0), ball, behind, 0.25f), 0.75f);
    const auto from = [&](float distance) {
        return unhidden(vec3(0, 2 - distance, 0), ball, vec4(0, 4, 0, 0.1f), 1);
    };
    EXPECT_EQ(from(4.9f), 0);
    EXPECT_NEAR(from(35.0f / 6), 0.5, 0.01); // a sine half-way from 1/5 to 1/7
    EXPECT_EQ(from(7.01f), 1);
}

TEST(Hidden, NoNormalOfAConeSeesLowerThanItsLowest)
{
    Random random;
    int positive = 0;
    for (int i = 0; i < 20000; ++i) {
        const vec3 axis(0, 1, 0), to = random.inBall(vec4(0, 0.7f, 0, 1));
        const float cutoff = random.uniform(-0.2f, 1);
        const float lowest = lowestOver(to, axis, cutoff);
        positive += lowest > 0;
        for (int k = 0; k < 20 && lowest > 0; ++k) {
            const float cosine = random.uniform(cutoff, 1), turn = random.uniform(0, 7);
            const float sine = std::sqrt(std::max(1 - cosine * cosine, 0.0f));
            const vec3 normal(sine * std::cos(turn), cosine, sine * std::sin(turn));
            ASSERT_GE(dot(normal, to), lowest - 1e-5f);
        }
    }
    EXPECT_GT(positive, 2000);
}

TEST(Hidden, ClustersAgreeWithTheirReceivers)
{
    Random random;
    int hidden = 0, untouched = 0;
    for (int i = 0; i < 20000; ++i) {
        const vec4 cluster(0, 0, 0, random.uniform(0.01f, 0.4f));
        const vec4 ball = random.ball(), sphere = random.sphere();
        const ShadowBounds bounds =
            shadowBounds(clusterShadow(cluster, ball), vec3(sphere), sphere.w);
        EXPECT_TRUE(bounds.touched || !bounds.hidden);
        hidden += bounds.hidden;
        untouched += !bounds.touched;
        for (int k = 0; k < 20; ++k) {
            const float weight = unhidden(random.inBall(cluster), ball, sphere, 1);
            if (bounds.hidden) {
                ASSERT_LT(weight, 1e-9f) << i;
            }
            if (!bounds.touched) {
                ASSERT_EQ(weight, 1) << i;
            }
        }
    }
    EXPECT_GT(hidden, 300);
    EXPECT_GT(untouched, 1000);
}

vec4 inscribedOf(const MeshAsset& mesh)
{
    Progress progress("test");
    return bakeMesh(mesh.positions, mesh.normals, mesh.indices,
                    {.shells = 12, .side = 17, .directions = 256, .rasterSide = 128}, progress)
        .field.head.inscribed;
}

TEST(InscribedSphere, FitsIntoTheObject)
{
    const vec4 ball = inscribedOf(makeSphereAsset(0.5f, 24, false));
    EXPECT_LT(length(vec3(ball)), 0.01);
    EXPECT_NEAR(ball.w, 0.5 * std::cos(M_PI / 48), 0.005); // its facets lie inside the sphere
    const vec4 box = inscribedOf(makeBoxAsset(vec3(0.3f, 0.4f, 0.5f), 4, false));
    EXPECT_NEAR(box.w, 0.3, 0.003);
    EXPECT_NEAR(box.x, 0, 0.003);
    EXPECT_LE(std::abs(box.y) + box.w, 0.4001f);
    EXPECT_LE(std::abs(box.z) + box.w, 0.5001f);
}

// Of two boxes side by side in one mesh the ball lies in the thicker one, away from the middle.
TEST(InscribedSphere, LiesWhereTheObjectIsThick)
{
    MeshAsset both = makeBoxAsset(vec3(0.1f, 0.4f, 0.4f), 2, false);
    const MeshAsset thick = makeBoxAsset(vec3(0.25f), 2, false);
    const auto first = static_cast<std::uint32_t>(both.positions.size());
    for (std::size_t i = 0; i < thick.positions.size(); ++i) {
        both.positions.push_back(thick.positions[i] + vec3(0.7f, 0, 0));
        both.normals.push_back(thick.normals[i]);
    }
    for (const std::uint32_t index : thick.indices)
        both.indices.push_back(first + index);
    const vec4 ball = inscribedOf(both);
    EXPECT_LT(length(vec3(ball) - vec3(0.7f, 0, 0)), 0.01);
    EXPECT_NEAR(ball.w, 0.25, 0.005);
}

// A room with a window, behind a baffle: its corners see nothing, its middle sees out.
TEST(InscribedSphere, IsNotWhereOneCanLookIn)
{
    MeshAsset room = makeBoxAsset(vec3(0.5f), 1, false);
    room.indices.erase(room.indices.begin(), room.indices.begin() + 6); // without the side at +x
    const auto first = static_cast<std::uint32_t>(room.positions.size());
    for (const vec2 corner :
         {vec2(-0.5f, -0.5f), vec2(-0.5f, 0.5f), vec2(0.3f, 0.5f), vec2(0.3f, -0.5f)}) {
        room.positions.emplace_back(0.2f, corner.x, corner.y);
        room.normals.emplace_back(1, 0, 0);
    }
    for (const std::uint32_t corner : {0, 1, 2, 0, 2, 3})
        room.indices.push_back(first + corner);
    EXPECT_LT(inscribedOf(room).w, 0.2f); // that of the whole room behind the baffle: .35
}

TEST(InscribedSphere, AnOpenMeshHasNone)
{
    MeshAsset sheet = makeBoxAsset(vec3(0.3f), 2, false);
    sheet.indices.resize(sheet.indices.size() / 6); // one face
    EXPECT_EQ(inscribedOf(sheet).w, 0);
}

// Large ones alone: what they hide must be worth the look.
TEST(Hidden, LargeOccludersHideOthers)
{
    const MeshAsset ball = makeSphereAsset(0.5f, 12);
    const SceneData scene =
        buildSceneData(std::array{&ball}, {{.mesh = 0, .occluder = 0},
                                           {.mesh = 0, .scale = 2, .occluder = 0},
                                           {.mesh = 0, .scale = 0.5f, .occluder = 0},
                                           {.mesh = 0, .scale = 3}});
    EXPECT_EQ(scene.hiders, (std::vector<bool>{false, true, false, false}));
    EXPECT_NEAR(updateInstances(scene).instances[1].inscribed.w, 1, 0.03);
    EXPECT_EQ(updateInstances(scene).instances[0].inscribed.w, 0);
    MeshAsset near = ball; // what is out of influence so soon could not fade before
    near.field->outerRadius = 6;
    EXPECT_FALSE(
        buildSceneData(std::array<const MeshAsset*, 2>{&ball, &near},
                       {{.mesh = 0, .occluder = 0}, {.mesh = 0, .scale = 2, .occluder = 1}})
            .hiders[1]);
}

class BehindABall : public ::testing::TestWithParam<Kernel> {};

// A sphere comes into the shadow that a ball throws for the floor, in steps of a millimetre.
TEST_P(BehindABall, ComesAndGoesWithoutAJump)
{
    const std::vector<MeshAsset> assets = {makeBoxAsset(vec3(0.05f), 7, false),
                                           makeSphereAsset(0.25f, 12), makeSphereAsset(0.2f, 12)};
    std::vector<const MeshAsset*> meshes;
    for (const MeshAsset& asset : assets)
        meshes.push_back(&asset);
    LightSh sky{};
    sky[0] = vec3(kSqrt4Pi);
    double largest = 0, dropped = 0;
    std::vector<vec4> last, least, most;
    for (int i = 0; i <= 600; ++i) {
        const SceneData scene = buildSceneData(
            meshes, {{.mesh = 0, .position = vec3(0, -0.05f, 0), .material = {vec3(1), 0, 0}},
                     {.mesh = 1, .position = vec3(0, 0.35f, 0), .occluder = 1},
                     {.mesh = 2,
                      .position = vec3(-0.6f + 0.001f * static_cast<float>(i), 0.95f, 0),
                      .occluder = 2}});
        ASSERT_TRUE(scene.hiders[1]);
        for (const ClusterEntities& cluster : sortAll(scene, updateInstances(scene)))
            dropped += static_cast<double>(cluster.hidden.size());
        std::vector<vec4> now = shadeAll(GetParam(), scene, frameConstants({}, sky, 1));
        now.resize(scene.firstRadiance[1]); // the floor
        if (i == 0)
            last = least = most = now;
        for (std::size_t v = 0; v < last.size(); ++v) {
            largest = std::max(largest, static_cast<double>(std::abs(now[v].x - last[v].x)));
            least[v] = min(least[v], now[v]);
            most[v] = max(most[v], now[v]);
        }
        last = std::move(now);
    }
    double change = 0; // all in all
    for (std::size_t v = 0; v < last.size(); ++v)
        change = std::max(change, static_cast<double>(most[v].x - least[v].x));
    EXPECT_GT(change, 20 * largest);
    EXPECT_GT(change, 0.002);
    EXPECT_GT(dropped, 20);
    EXPECT_LT(largest, 0.002); // half of 1 / 255 of the sky
    RecordProperty("step", fmt::format("{} of {}", largest, change));
}

// A ball before a lamp rises until it is out of influence: the lamp comes up slowly behind it.
TEST_P(BehindABall, GoesOutOfReachWithoutAJump)
{
    const std::vector<MeshAsset> assets = {makeBoxAsset(vec3(0.05f), 7, false),
                                           makeSphereAsset(0.1f, 12),
                                           makeSphereLight(0.08f, vec3(100))};
    std::vector<const MeshAsset*> meshes;
    for (const MeshAsset& asset : assets)
        meshes.push_back(&asset);
    double largest = 0, brightest = 0;
    int dropped = 0;
    std::vector<vec4> last;
    for (int i = 0; i <= 600; ++i) {
        const float height = 0.3f + 0.001f * static_cast<float>(i);
        const SceneData scene = buildSceneData(
            meshes,
            {{.mesh = 0, .position = vec3(0, -0.05f, 0), .material = {vec3(1), 0, 0}},
             {.mesh = 1, .position = vec3(0, height, 0), .occluder = 1}},
            {{.asset = 2, .position = vec3(0, height + 0.25f, 0)}});
        ASSERT_TRUE(scene.hiders[1]);
        for (const ClusterEntities& cluster : sortAll(scene, updateInstances(scene)))
            dropped += cluster.lights.empty();
        std::vector<vec4> now = shadeAll(GetParam(), scene, frameConstants({}, LightSh{}, 0));
        now = {now.begin() + 2 * kClusterReceivers, now.begin() + 3 * kClusterReceivers}; // on top
        for (std::size_t v = 0; v < last.size(); ++v) {
            largest = std::max(largest, static_cast<double>(std::abs(now[v].x - last[v].x)));
            brightest = std::max(brightest, static_cast<double>(now[v].x));
        }
        last = std::move(now);
    }
    EXPECT_GT(dropped, 20); // at first
    EXPECT_GT(brightest, 0.01);
    EXPECT_LT(largest, 0.04 * brightest);
    RecordProperty("step", fmt::format("{} of {}", largest, brightest));
}

INSTANTIATE_TEST_SUITE_P(Kernels, BehindABall, ::testing::Values(Kernel::Literal, Kernel::Exact));

} // namespace
} // namespace penumbra
