#include "runtime/ecs/schedule.h"
#include "tests/runtime/ecs/components.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <chrono>
#include <cstring>
#include <thread>

namespace penumbra::ecs {

namespace {

using Log = std::vector<std::string>;

void waitMs(int ms)
{
    std::this_thread::sleep_for(std::chrono::milliseconds(ms));
}

// All values of all entities, in index order, as bytes.
std::string imageOf(World& world)
{
    std::vector<Entity> entities;
    world.query<>().each([&](Entity entity) { entities.push_back(entity); });
    std::string image;
    const auto append = [&](const auto& value) {
        image.append(reinterpret_cast<const char*>(&value), sizeof(value));
    };
    for (const Entity entity : entities) { // in storage order, which must agree as well
        append(entity);
        append(world.version());
        if (world.has<Position>(entity))
            append(world.value<Position>(entity));
        if (world.has<Velocity>(entity))
            append(world.value<Velocity>(entity));
        if (world.has<Health>(entity))
            append(world.value<Health>(entity));
        if (world.has<Parent>(entity))
            append(world.value<Parent>(entity));
    }
    return image;
}

// A frame with everything in it: parallel loops, reads of others' writes, changed rows, structure.
std::string simulate(int threads)
{
    tbb::task_arena arena(threads);
    return arena.execute([&] {
        World world;
        std::vector<Entity> entities(20000);
        world.createMany(entities, Position{1, 2, 3}, Velocity{1, 0.5f, 0.25f}, Health{100});
        Schedule schedule(world, {"simulate", "react"});
        schedule.add<Position, const Velocity>("integrate", "simulate", [](SystemContext& context) {
            context.query<Position, const Velocity>().parallelEach(
                [](Position& p, const Velocity& v) {
                    p.x += v.x * 0.1f;
                    p.y += v.y * p.x;
                    p.z *= 1.0001f;
                });
        });
        // Reads what integrate writes and writes what it reads: out of order, other bits.
        schedule.add<const Position, Velocity>("drag", "simulate", [](SystemContext& context) {
            context.query<const Position, Velocity>().parallelEach(
                [](const Position& p, Velocity& v) { v.y = v.y * 0.99f - p.x * 0.001f; });
        });
        schedule.add<Health>("age", "simulate", [](SystemContext& context) {
            const auto frame = static_cast<uint32_t>(context.version());
            context.query<const Health>().each([&](Entity entity, const Health&) {
                if ((entity.index * 2654435761u + frame) % 61 == 0)
                    context.get<Health>(entity).points -= 10;
            });
        });
        schedule.add<const Health, Velocity>("slow", "react", [](SystemContext& context) {
            context.query<const Health, Velocity, Changed<Health>>().parallelEach(
                [](const Health& h, Velocity& v) { v.x *= 0.01f * static_cast<float>(h.points); });
        });
        schedule.add<const Health>("die", "react", [](SystemContext& context) {
            CommandBuffer& commands = context.commands();
            context.query<const Health, Changed<Health>>().each(
                [&](Entity entity, const Health& h) {
                    if (h.points < 80)
                        commands.destroy(entity);
                    else if (h.points < 90)
                        commands.remove<Velocity>(entity);
                });
        });
        schedule.add<const Position>("spawn", "react", [](SystemContext& context) {
            CommandBuffer& commands = context.commands();
            uint32_t count = 0;
            context.query<const Position>().each([&](Entity entity, const Position& p) {
                if (entity.index % 4001 == 0 && ++count < 20)
                    commands.create(p, Velocity{p.y, 0, 0}, Health{100}, Parent{entity});
            });
        });
        for (int frame = 0; frame < 30; ++frame)
            schedule.run();
        return imageOf(world);
    });
}

} // namespace

// TBB must be allowed four workers even on a machine with fewer cores.
struct ScheduleThreads : testing::Test {
    tbb::global_control control{tbb::global_control::max_allowed_parallelism, 4};
};

TEST_F(ScheduleThreads, GiveEqualBits)
{
    const std::string one = simulate(1);
    EXPECT_GT(one.size(), 100000u);
    for (int repeat = 0; repeat < 3; ++repeat) {
        EXPECT_TRUE(simulate(2) == one);
        EXPECT_TRUE(simulate(4) == one);
    }
}

// Conflicting systems keep the order in which they were added, however long the first takes.
TEST_F(ScheduleThreads, KeepTheOrderOfConflictingSystems)
{
    tbb::task_arena arena(4);
    arena.execute([] {
        World world;
        world.create(Position{}, Health{});
        Schedule schedule(world, {"first", "second"});
        std::atomic<int> step = 0;
        int early = 0;
        int late = 0;
        int reader = 0;
        int after = 0;
        schedule.add<>("after", "second", [&](SystemContext&) { after = ++step; });
        schedule.add<Health>("early", "first", [&](SystemContext&) {
            waitMs(20);
            early = ++step;
        });
        schedule.add<const Health>("reader", "first", [&](SystemContext&) {
            waitMs(5);
            reader = ++step;
        });
        schedule.add<Health, Position>("late", "first", [&](SystemContext&) { late = ++step; });
        for (int i = 0; i < 3; ++i) {
            step = 0;
            schedule.run();
            EXPECT_EQ(early, 1);
            EXPECT_EQ(reader, 2);
            EXPECT_EQ(late, 3);
            EXPECT_EQ(after, 4);
        }
    });
}

TEST_F(ScheduleThreads, RunUnrelatedSystemsAtOnce)
{
    tbb::task_arena arena(4);
    arena.execute([] {
        World world;
        Schedule schedule(world, {"only"});
        std::atomic<int> inside = 0;
        std::atomic<bool> met = false;
        const auto meet = [&](SystemContext&) {
            ++inside;
            for (int i = 0; i < 2000 && inside < 2; ++i)
                waitMs(1);
            met = met || inside == 2;
        };
        schedule.add<Health>("a", "only", meet);
        schedule.add<Position, const Velocity>("b", "only", meet);
        schedule.run();
        EXPECT_TRUE(met);
    });
}

TEST(Schedule, ChangedMeansSinceTheOwnLastRun)
{
    World world;
    std::vector<Entity> entities(1000);
    world.createMany(entities, Health{});
    uint32_t early = 0;
    uint32_t late = 0;
    uint32_t target = 0;
    const auto countChanged = [](SystemContext& context, uint32_t& count) {
        count = 0;
        context.query<const Health, Changed<Health>>().each([&](const Health&) { ++count; });
    };
    Schedule schedule(world, {"only"});
    schedule.add<const Health>("early", "only", [&](SystemContext& c) { countChanged(c, early); });
    schedule.add<Health>("write", "only", [&](SystemContext& context) {
        context.get<Health>(entities[target++]).points = 1;
    });
    schedule.add<const Health>("late", "only", [&](SystemContext& c) { countChanged(c, late); });
    schedule.run();
    EXPECT_EQ(early, 1000u); // all are new
    EXPECT_EQ(late, 1000u);
    for (int frame = 0; frame < 5; ++frame) {
        schedule.run();
        EXPECT_EQ(early, 1u) << frame; // the write of the frame before
        EXPECT_EQ(late, 1u) << frame;  // the write of this frame, and only that
    }
    world.get<Health>(entities[999]).points = 1; // between frames
    schedule.run();
    EXPECT_EQ(early, 2u);
    EXPECT_GE(late, 2u);
}

TEST(Schedule, PlaysCommandsAtTheEndInSystemOrder)
{
    World world;
    const Entity entity = world.create(Health{0});
    Schedule schedule(world, {"first", "second"});
    schedule.add<>("later", "second",
                   [&](SystemContext& c) { c.commands().set(entity, Health{2}); });
    schedule.add<>("sooner", "first",
                   [&](SystemContext& c) { c.commands().set(entity, Health{1}); });
    schedule.add<const Health>("look", "second", [&](SystemContext& c) {
        EXPECT_EQ(c.get<const Health>(entity).points, 0u);
    });
    EXPECT_EQ(schedule.run().commands, 2u);
    EXPECT_EQ(world.get<const Health>(entity).points, 2u);
}

TEST(Schedule, GivesAccessToSingletonsAndHierarchy)
{
    World world;
    world.setSingleton(Gravity{2});
    const Entity root = world.create(Velocity{});
    const Entity child = world.create(Parent{root});
    Schedule schedule(world, {"only"});
    schedule.add<const Gravity, Velocity>("fall", "only", [&](SystemContext& c) {
        Velocity velocity = c.value<Velocity>(root);
        velocity.y -= c.singleton<const Gravity>().metresPerSecond2;
        c.set(root, velocity);
        EXPECT_EQ(c.hierarchy().order().size(), 2u);
        EXPECT_EQ(c.hierarchy().parentOf(child), root);
        EXPECT_TRUE(c.alive(child) && c.has<Parent>(child));
        EXPECT_EQ(c.tryGet<const Gravity>(child), nullptr);
    });
    schedule.run();
    EXPECT_EQ(world.value<Velocity>(root).y, -2);
}

TEST(Schedule, ReportsTimesAndGraph)
{
    World world;
    Schedule schedule(world, {"simulate", "draw"});
    schedule.add<Health>("slow", "simulate", [](SystemContext&) { waitMs(3); });
    schedule.add<const Health>("fast", "simulate", [](SystemContext&) {});
    schedule.add<const Health>("show", "draw", [](SystemContext&) {});
    for (uint32_t i = 0; i < Schedule::kTimingFrames + 3; ++i)
        schedule.run();
    const auto timings = schedule.timings();
    ASSERT_EQ(timings.size(), 3u);
    EXPECT_EQ(timings[0].name, "slow");
    EXPECT_GE(timings[0].medianMs, 2.5);
    EXPECT_LT(timings[1].medianMs, 2.5);

    const std::string dot = schedule.toDot();
    EXPECT_NE(dot.find("digraph"), std::string::npos);
    EXPECT_NE(dot.find("\"slow\" -> \"fast\" [label=\"test.Health\"]"), std::string::npos) << dot;
    EXPECT_EQ(dot.find("\"fast\" -> \"show\""), std::string::npos) << dot;
    EXPECT_NE(dot.find("label=\"draw\""), std::string::npos) << dot;

    EXPECT_EXIT(schedule.add<>("x", "nowhere", [](SystemContext&) {}), testing::ExitedWithCode(3),
                "no phase 'nowhere'");
    EXPECT_EXIT(schedule.add<>("slow", "draw", [](SystemContext&) {}), testing::ExitedWithCode(3),
                "two systems are called 'slow'");
}

#ifndef NDEBUG
TEST(Schedule, RefusesUndeclaredAccess)
{
    World world;
    const Entity entity = world.create(Health{}, Velocity{});
    const auto runOne = [&](auto system) {
        Schedule schedule(world, {"only"});
        schedule.add<const Health>("sly", "only", system);
        schedule.run();
    };
    EXPECT_EXIT(runOne([](SystemContext& c) { static_cast<void>(c.query<Health>()); }),
                testing::ExitedWithCode(3), "'sly' writes test.Health without declaring it");
    EXPECT_EXIT(runOne([&](SystemContext& c) { static_cast<void>(c.value<Velocity>(entity)); }),
                testing::ExitedWithCode(3), "'sly' reads test.Velocity without declaring it");
    EXPECT_EXIT(runOne([&](SystemContext&) { static_cast<void>(world.query<const Health>()); }),
                testing::ExitedWithCode(3), "World used inside a system");
    EXPECT_EXIT(runOne([&](SystemContext&) { world.destroy(entity); }), testing::ExitedWithCode(3),
                "structural change of .* in system .sly.");
}
#endif

} // namespace penumbra::ecs
