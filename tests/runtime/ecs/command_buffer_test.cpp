#include "runtime/ecs/command_buffer.h"
#include "tests/runtime/ecs/components.h"

#include <gtest/gtest.h>

namespace penumbra::ecs {

TEST(CommandBuffer, ChangesNothingBeforePlayback)
{
    World world;
    const Entity entity = world.create(Health{1});
    CommandBuffer commands;
    commands.create(Health{2});
    commands.add(entity, Position{});
    commands.destroy(entity);
    EXPECT_EQ(world.count(), 1u);
    EXPECT_FALSE(world.has<Position>(entity));
    play(world, commands);
    EXPECT_FALSE(world.alive(entity));
    EXPECT_EQ(world.count(), 1u);
    EXPECT_TRUE(commands.isEmpty());
}

TEST(CommandBuffer, MergesAllCommandsOfAnEntityIntoOneMove)
{
    World world;
    const Entity entity = world.create(Health{1}, Position{1, 2, 3});
    CommandBuffer commands;
    commands.add(entity, Velocity{1, 0, 0}, Frozen{});
    commands.remove<Position>(entity);
    commands.add(entity, Velocity{2, 0, 0}); // the later value
    commands.set(entity, Health{9});
    commands.add(entity, Wide{});
    commands.remove<Wide>(entity); // came and went
    commands.set(entity, Wide{});  // absent by now
    const PlaybackStatistics statistics = play(world, commands);
    EXPECT_EQ(statistics.moves, 1u);
    EXPECT_EQ(statistics.commands, 8u);
    EXPECT_EQ(statistics.dropped, 1u);
    EXPECT_EQ(world.components(entity), (componentSet<Health, Velocity, Frozen>().mask));
    EXPECT_EQ(world.value<Velocity>(entity).x, 2);
    EXPECT_EQ(world.get<const Health>(entity).points, 9u);
}

TEST(CommandBuffer, DeferredEntitiesAreTargetsAndValues)
{
    World world;
    CommandBuffer first(1);
    CommandBuffer second(2);
    const Entity a = first.create(Health{1});
    const Entity b = first.create(Health{2}, Link{5, a});
    first.add(a, Link{6, b}, Frozen{});
    const Entity other = second.create(Health{3});
    second.create(Health{4}, Parent{other});
    CommandBuffer* const both[] = {&first, &second};
    play(world, both);

    Entity byPoints[5];
    world.query<const Health>().each(
        [&](Entity entity, const Health& h) { byPoints[h.points] = entity; });
    EXPECT_EQ(world.get<const Link>(byPoints[1]).to, byPoints[2]);
    EXPECT_EQ(world.get<const Link>(byPoints[2]).to, byPoints[1]);
    EXPECT_EQ(world.get<const Link>(byPoints[2]).weight, 5u);
    EXPECT_TRUE(world.has<Frozen>(byPoints[1]));
    EXPECT_EQ(world.hierarchy().parentOf(byPoints[4]), byPoints[3]);

    first.add(other, Frozen{});
    EXPECT_EXIT(play(world, first), testing::ExitedWithCode(3), "belongs to another buffer");
    first.clear();
    first.add(a, Frozen{}); // of the playback before
    EXPECT_EXIT(play(world, first), testing::ExitedWithCode(3), "already played");
    EXPECT_EXIT(static_cast<void>(world.has<Health>(a)), testing::ExitedWithCode(3),
                "real after playback");
}

TEST(CommandBuffer, BuffersPlayInTheOrderGiven)
{
    World world;
    const Entity entity = world.create(Health{0});
    CommandBuffer first;
    CommandBuffer second;
    second.set(entity, Health{2}); // recorded first, played second
    first.set(entity, Health{1});
    CommandBuffer* const both[] = {&first, &second};
    play(world, both);
    EXPECT_EQ(world.get<const Health>(entity).points, 2u);
}

TEST(CommandBuffer, MeetsAChangedWorld)
{
    World world;
    const Entity dead = world.create();
    const Entity child = world.create();
    CommandBuffer commands;
    commands.add(dead, Health{});
    commands.destroy(dead);
    commands.setParent(child, dead);
    commands.create(Parent{dead});
    world.destroy(dead);
    const PlaybackStatistics statistics = play(world, commands);
    EXPECT_EQ(statistics.dropped, 2u);
    EXPECT_EQ(world.count(), 0u); // both children shared the parent's fate
    EXPECT_TRUE(world.hierarchy().order().empty());
}

TEST(CommandBuffer, DestroyWinsAndCascades)
{
    World world;
    const Entity root = world.create(Health{1});
    CommandBuffer commands;
    commands.destroy(root);
    commands.add(root, Position{});
    commands.create(Health{2}, Parent{root});
    play(world, commands);
    EXPECT_EQ(world.count(), 0u);
}

TEST(CommandBuffer, RefusesCyclesAndKeepsTheOldParent)
{
    World world;
    const Entity a = world.create();
    const Entity b = world.create();
    const Entity old = world.create();
    const Entity c = world.create(Parent{old});
    CommandBuffer commands;
    commands.setParent(a, b);
    commands.setParent(b, a);   // refused: b had no parent
    commands.setParent(old, c); // refused: c is below old
    EXPECT_EQ(play(world, commands).refused, 2u);
    EXPECT_EQ(world.hierarchy().parentOf(a), b);
    EXPECT_FALSE(world.has<Parent>(b));
    EXPECT_FALSE(world.has<Parent>(old));
    commands.setParent(c, c);
    EXPECT_EQ(play(world, commands).refused, 1u);
    EXPECT_EQ(world.get<const Parent>(c).entity, old);
}

TEST(CommandBuffer, MovesManyWithTheirValues)
{
    World world;
    std::vector<Entity> entities(5000);
    std::vector<Health> health(entities.size());
    for (uint32_t i = 0; i < health.size(); ++i)
        health[i].points = i;
    world.createMany(entities, std::span(health), Velocity{1, 2, 3});
    CommandBuffer commands;
    for (uint32_t i = 0; i < entities.size(); ++i) {
        if (i % 3 == 0)
            commands.add(entities[i], Position{static_cast<float>(i), 0, 0});
        if (i % 5 == 0)
            commands.remove<Velocity>(entities[i]);
        if (i % 7 == 0)
            commands.destroy(entities[i]);
    }
    play(world, commands);
    for (uint32_t i = 0; i < entities.size(); ++i) {
        ASSERT_EQ(world.alive(entities[i]), i % 7 != 0);
        if (i % 7 == 0)
            continue;
        ASSERT_EQ(world.get<const Health>(entities[i]).points, i);
        ASSERT_EQ(world.has<Velocity>(entities[i]), i % 5 != 0);
        ASSERT_EQ(world.has<Position>(entities[i]), i % 3 == 0);
        if (i % 3 == 0) {
            ASSERT_EQ(world.get<const Position>(entities[i]).x, static_cast<float>(i));
        }
    }
}

} // namespace penumbra::ecs
