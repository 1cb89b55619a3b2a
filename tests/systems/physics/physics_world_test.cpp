#include "systems/physics/physics_world.h"

#include <algorithm>
#include <cstring>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace penumbra {
namespace {

constexpr std::uint64_t kFloorId = 1;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

BodyDescription makeFloor()
{
    return {
        .id = kFloorId, .shape = *boxShape({4, 0.1f, 4}), .pose = {{0, -0.1f, 0}}}; // top at y = 0
}

BodyDescription makeBody(std::uint64_t id, CollisionShape shape, vec3 position, float mass = 1)
{
    return {.id = id, .shape = std::move(shape), .mass = mass, .pose = {position}};
}

// A cup without a bottom: eight walls around the y axis, radius about 0.15.
CollisionShape makeTubeShape()
{
    std::vector<std::vector<vec3>> walls;
    for (int i = 0; i < 8; ++i) {
        std::vector<vec3>& wall = walls.emplace_back();
        for (const float angle :
             {0.7854f * static_cast<float>(i), 0.7854f * static_cast<float>(i + 1)}) {
            for (const float radius : {0.12f, 0.15f}) {
                for (const float y : {-0.12f, 0.12f})
                    wall.push_back({radius * cos(angle), y, radius * sin(angle)});
            }
        }
    }
    return *compoundShape(walls);
}

CollisionShape makeConeShape()
{
    std::vector<vec3> points{{0, 0.2f, 0}};
    for (int i = 0; i < 24; ++i)
        points.push_back({0.15f * cos(0.2618f * static_cast<float>(i)), -0.1f,
                          0.15f * sin(0.2618f * static_cast<float>(i))});
    return *hullShape(points);
}

// Four kinds of shape, in a column above the floor, turned and pushed by a seed. They start apart.
std::vector<BodyDescription> makePile(std::uint32_t seed, int count)
{
    const CollisionShape shapes[] = {*boxShape({0.15f, 0.1f, 0.12f}), *sphereShape(0.14f),
                                     makeTubeShape(), makeConeShape()};
    std::mt19937 random(seed);
    const auto next = [&] {
        return static_cast<float>(random() % 2001) / 1000.0f - 1;
    }; // -1..1, on any library
    std::vector<BodyDescription> bodies{makeFloor()};
    bodies[0].shape = *boxShape({40, 0.1f, 40}); // wide: balls roll far
    for (int i = 0; i < count; ++i) {
        BodyDescription body =
            makeBody(static_cast<std::uint64_t>(100 + 7 * i), shapes[i % 4],
                     {0.4f * next(), 0.5f + 0.4f * static_cast<float>(i), 0.4f * next()});
        body.pose.rotation = normalize(quat(next(), next(), next(), next()) + quat(2.1f, 0, 0, 0));
        body.motion.angularVelocity = 3.0f * vec3(next(), next(), next());
        bodies.push_back(std::move(body));
    }
    return bodies;
}

void stepSeconds(PhysicsWorld& world, int seconds)
{
    for (int i = 0; i < 60 * seconds; ++i)
        world.step(1.0f / 60);
}

// Semi-implicit Euler falls g dt² n (n + 1) / 2, half a step more than g t² / 2.
TEST(PhysicsWorld, FallsWithGravity)
{
    BodyDescription body = makeBody(5, *sphereShape(0.1f), {1, 20, 2});
    body.linearDamping = 0;
    PhysicsWorld world = *PhysicsWorld::build({body});
    stepSeconds(world, 1);
    const float t = 1, g = 9.81f;
    EXPECT_NEAR(world.pose(5).position.y, 20 - g * t * t / 2 - g * t * PhysicsWorld::kStep / 2,
                1e-3f);
    EXPECT_NEAR(world.motion(5).velocity.y, -g * t, 1e-3f);
    EXPECT_EQ(world.pose(5).position.x, 1);
}

// Without torque a body keeps turning about its mass centre, wherever the mesh has its origin.
TEST(PhysicsWorld, TurnsAboutTheMassCentre)
{
    std::vector<vec3> points;
    for (int i = 0; i < 8; ++i) // a cube around (1, 2, 3)
        points.push_back(vec3(1, 2, 3) +
                         0.1f * vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
    BodyDescription body = makeBody(9, *hullShape(points), {0, 0, 0});
    body.motion.angularVelocity = {0, 2, 0};
    body.angularDamping = body.linearDamping = 0;
    PhysicsWorld world = *PhysicsWorld::build({body}, {.gravity = vec3(0)});
    stepSeconds(world, 1);
    const Pose pose = world.pose(9);
    EXPECT_LT(length(pose.rotation * vec3(1, 2, 3) + pose.position - vec3(1, 2, 3)), 1e-3f);
    EXPECT_NEAR(2 * std::atan2(pose.rotation.y, pose.rotation.w), 2, 1e-3f);
}

TEST(PhysicsWorld, ShapesRestOnTheFloor)
{
    const struct {
        const char* name;
        CollisionShape shape;
        float height; // of the origin when at rest
    } cases[] = {{"box", *boxShape({0.15f, 0.1f, 0.12f}), 0.1f},
                 {"sphere", *sphereShape(0.15f), 0.15f},
                 {"cone", makeConeShape(), 0.1f},
                 {"tube", makeTubeShape(), 0.12f}};
    for (const auto& c : cases) {
        SCOPED_TRACE(c.name);
        PhysicsWorld world =
            *PhysicsWorld::build({makeFloor(), makeBody(2, c.shape, {0, 0.3f, 0})});
        stepSeconds(world, 5);
        EXPECT_TRUE(world.sleeping(2));
        EXPECT_NEAR(world.pose(2).position.y, c.height, 2e-3f); // seen to touch: no margin shows
        EXPECT_LT(length(world.motion(2).velocity), 0.01f);
        const Pose before = world.interpolated(2);
        world.step(0.013f);
        const Pose after = world.interpolated(2);
        EXPECT_EQ(std::memcmp(&before, &after, sizeof(Pose)), 0) << "it jitters";
    }
}

TEST(PhysicsWorld, GroundHoldsWhatLeavesTheFloor)
{
    BodyDescription ground{.id = 3, .shape = *groundShape(-2)};
    PhysicsWorld world =
        *PhysicsWorld::build({ground, makeBody(4, *sphereShape(0.2f), {50, -1, 0})});
    stepSeconds(world, 4);
    EXPECT_NEAR(world.pose(4).position.y, -1.8f, 2e-3f);
}

TEST(PhysicsWorld, PileSettles)
{
    for (const std::uint32_t seed : {1u, 2u, 3u}) {
        const std::vector<BodyDescription> bodies = makePile(seed, 20);
        PhysicsWorld world = *PhysicsWorld::build(bodies);
        stepSeconds(world, 6);
        int awake = 0;
        for (const BodyDescription& body : bodies) {
            EXPECT_LT(length(world.motion(body.id).velocity), 0.15f)
                << "seed " << seed << ", body " << body.id;
            if (body.id == kFloorId)
                continue;
            EXPECT_GT(world.pose(body.id).position.y, 0.08f)
                << "seed " << seed << ", body " << body.id;
            awake += world.sleeping(body.id) ? 0 : 1;
        }
        EXPECT_LT(world.deepestOverlap(), 0.005f) << "seed " << seed;
        RecordProperty("awake_after_6s_seed" + std::to_string(seed), awake);
        stepSeconds(world, 6);
        for (const BodyDescription& body : bodies)
            EXPECT_TRUE(world.sleeping(body.id)) << "seed " << seed << ", body " << body.id;
    }
}

std::vector<Pose> runPile(std::vector<BodyDescription> bodies)
{
    PhysicsWorld world = *PhysicsWorld::build(bodies);
    std::sort(bodies.begin(), bodies.end(),
              [](const auto& a, const auto& b) { return a.id < b.id; });
    std::vector<Pose> poses;
    for (int i = 0; i < 240; ++i) {
        world.step(1.0f / 60);
        for (const BodyDescription& body : bodies)
            poses.push_back(world.interpolated(body.id));
    }
    return poses;
}

TEST(PhysicsWorld, SameBitsInAnyOrderOfBodies)
{
    std::vector<BodyDescription> bodies = makePile(4, 20);
    const std::vector<Pose> first = runPile(bodies), again = runPile(bodies);
    std::reverse(bodies.begin(), bodies.end());
    std::swap(bodies[3], bodies[11]);
    const std::vector<Pose> shuffled = runPile(bodies);
    const std::vector<Pose> other = runPile(makePile(5, 20));
    EXPECT_EQ(std::memcmp(first.data(), again.data(), first.size() * sizeof(Pose)), 0);
    EXPECT_EQ(std::memcmp(first.data(), shuffled.data(), first.size() * sizeof(Pose)), 0);
    EXPECT_NE(std::memcmp(first.data(), other.data(), first.size() * sizeof(Pose)), 0)
        << "the check sees nothing";
}

// How time is cut into calls does not matter, only how much of it has passed.
TEST(PhysicsWorld, StepsAreWholeAndKeepTheRemainder)
{
    PhysicsWorld coarse = *PhysicsWorld::build(makePile(6, 4)),
                 fine = *PhysicsWorld::build(makePile(6, 4));
    int coarseSteps = 0, fineSteps = 0;
    for (int i = 0; i < 60; ++i)
        coarseSteps += coarse.step(1.0f / 32);
    for (int i = 0; i < 60 * 8; ++i)
        fineSteps += fine.step(1.0f / 256);
    EXPECT_EQ(coarseSteps, 225); // 60 / 32 s
    EXPECT_EQ(fineSteps, coarseSteps);
    EXPECT_EQ(coarse.pose(100).position, fine.pose(100).position);
}

TEST(PhysicsWorld, InterpolatesBetweenSteps)
{
    BodyDescription body = makeBody(1, *sphereShape(0.1f), {0, 0, 0});
    body.motion = {.velocity = {1.2f, 0, 0}, .angularVelocity = {0, 0, 6}};
    body.linearDamping = body.angularDamping = 0;
    PhysicsWorld world = *PhysicsWorld::build({body}, {.gravity = vec3(0)});
    EXPECT_EQ(world.interpolated(1).position, vec3(0));
    EXPECT_EQ(world.step(2.25f * PhysicsWorld::kStep), 2);
    const float t = 1.25f * PhysicsWorld::kStep; // a quarter past step 1 of the two
    EXPECT_NEAR(world.interpolated(1).position.x, 1.2f * t, 1e-5f);
    EXPECT_NEAR(2 * std::atan2(world.interpolated(1).rotation.z, world.interpolated(1).rotation.w),
                6 * t, 1e-4f);
    EXPECT_NEAR(world.pose(1).position.x, 1.2f * 2 * PhysicsWorld::kStep, 1e-5f);
}

TEST(PhysicsWorld, ALongPauseIsDropped)
{
    PhysicsWorld world = *PhysicsWorld::build({makeBody(1, *sphereShape(0.1f), {0, 9, 0})});
    EXPECT_EQ(world.step(1000), PhysicsWorld::kMaxSteps);
    EXPECT_EQ(world.step(PhysicsWorld::kStep), 1);
}

TEST(PhysicsWorld, ImpulseWakesAndMoves)
{
    PhysicsWorld world = *PhysicsWorld::build(
        {makeFloor(), makeBody(2, *boxShape({0.1f, 0.1f, 0.1f}), {0, 0.1f, 0}, 2)});
    stepSeconds(world, 4);
    ASSERT_TRUE(world.sleeping(2));
    world.addImpulse(2, {0, 6, 0}, world.pose(2).position);
    EXPECT_FALSE(world.sleeping(2));
    EXPECT_NEAR(world.motion(2).velocity.y, 3, 1e-4f);
    world.addImpulse(kFloorId, {0, 6, 0}, vec3(0)); // ignored
    stepSeconds(world, 1);
    EXPECT_EQ(world.pose(kFloorId).position, makeFloor().pose.position);
}

TEST(PhysicsWorld, RefusesUnsoundBodies)
{
    const BodyDescription good = makeBody(7, *sphereShape(0.1f), {0, 1, 0});
    ASSERT_TRUE(PhysicsWorld::build({good}).ok());
    const auto refused = [&](const char* word, auto spoil) {
        BodyDescription body = good;
        spoil(body);
        const auto world = PhysicsWorld::build({makeFloor(), body});
        ASSERT_FALSE(world.ok()) << word;
        EXPECT_NE(world.error().message.find(word), std::string::npos) << world.error().message;
        EXPECT_NE(world.error().message.find("body"), std::string::npos) << world.error().message;
    };
    refused("mass", [](BodyDescription& b) { b.mass = kNan; });
    refused("mass", [](BodyDescription& b) { b.mass = -1; });
    refused("mass", [](BodyDescription& b) { b.mass = 0, b.motion.velocity = {1, 0, 0}; });
    refused("ground", [](BodyDescription& b) { b.shape = *groundShape(0); });
    refused("position", [](BodyDescription& b) { b.pose.position.z = kNan; });
    refused("quaternion", [](BodyDescription& b) { b.pose.rotation = quat(0, 0, 0, 0); });
    refused("quaternion", [](BodyDescription& b) { b.pose.rotation.x = kNan; });
    refused("velocity", [](BodyDescription& b) { b.motion.angularVelocity.x = kNan; });
    refused("friction", [](BodyDescription& b) { b.friction = -0.1f; });
    refused("restitution", [](BodyDescription& b) { b.restitution = 1.5f; });
    refused("damping", [](BodyDescription& b) { b.angularDamping = kNan; });
    refused("same id", [](BodyDescription& b) { b.id = kFloorId; });
    EXPECT_FALSE(PhysicsWorld::build({good}, {.gravity = vec3(kNan)}).ok());
    EXPECT_FALSE(PhysicsWorld::build({good}, {.solverIterations = 0}).ok());
}

} // namespace
} // namespace penumbra
