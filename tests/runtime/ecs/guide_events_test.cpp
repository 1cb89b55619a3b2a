// Samples of docs/ecs.md: commands, observers, hierarchy, changes. See guide_components.h.
#include "runtime/ecs/observers.h"
#include "tests/runtime/ecs/guide_components.h"

#include <gtest/gtest.h>

namespace game {

TEST(Guide, Commands)
{
    World world;
    const Entity old = world.create(Health{0});
    const Entity fresh = world.create(Health{9});
    // [commands]
    CommandBuffer commands;
    world.query<const Health>().each([&](Entity entity, const Health& health) {
        if (health.points == 0)
            commands.destroy(entity);
        else
            commands.add(entity, Frozen{});
    });
    const Entity spark = commands.create(Position{1, 2, 3}); // deferred: real after play()
    commands.create(Target{spark});                          // as a value it is remapped
    const PlaybackStatistics done = play(world, commands);
    EXPECT_FALSE(world.alive(old));
    world.query<const Target>().each(
        [&](const Target& target) { EXPECT_TRUE(world.alive(target.entity)); });
    // [end]
    EXPECT_TRUE(world.has<Frozen>(fresh));
    EXPECT_EQ(done.dropped, 0u);
    EXPECT_FALSE(world.alive(spark));
}

TEST(Guide, Merge)
{
    World world;
    const Entity entity = world.create(Position{});
    const Entity dead = world.create();
    world.destroy(dead);
    // [merge]
    CommandBuffer first(1), second(2); // tags: no deferred entity is taken for the other's
    first.add(entity, Velocity{1, 0, 0}, Health{1});
    first.remove<Position>(entity);
    second.add(entity, Health{2}); // played later: wins
    second.set(dead, Health{});    // dropped, counted
    CommandBuffer* const buffers[] = {&first, &second};
    const PlaybackStatistics done = play(world, buffers);
    EXPECT_EQ(done.moves, 1u); // once, for add, remove and add
    EXPECT_EQ(done.dropped, 1u);
    EXPECT_EQ(world.get<const Health>(entity).points, 2u);
    // [end]
}

TEST(Guide, Observers)
{
    World world;
    // [observers]
    std::vector<Entity> gone;
    const Observer born = onAdd<Health>(world, [](const Observation& seen) {
        for (const Entity entity : seen.entities) // all with the same components
            if (seen.world.get<const Health>(entity).points == 0)
                seen.commands.add(entity, Frozen{});
    });
    const Observer died = onRemove<Health>(world, [&](const Observation& seen) {
        if (seen.ending) // destroyed, not only removed; the value can still be read
            gone.insert(gone.end(), seen.entities.begin(), seen.entities.end());
    });
    const Entity stone = world.create(Health{0});
    EXPECT_TRUE(world.has<Frozen>(stone)); // the observer's commands are made by now
    world.destroy(stone);
    EXPECT_EQ(gone, std::vector{stone});
    // [end]
}

TEST(Guide, Hierarchy)
{
    World world;
    // [hierarchy]
    const Entity body = world.create(Local{10}, Global{});
    const Entity arm = world.create(Local{1}, Global{}, Parent{body});
    const Entity hand = world.create(Local{2}, Global{});
    EXPECT_TRUE(world.setParent(hand, arm));
    EXPECT_FALSE(world.setParent(body, hand)); // would close a cycle: nothing changed
    EXPECT_EQ(world.hierarchy().parentOf(hand), arm);
    EXPECT_EQ(world.hierarchy().childrenOf(body), std::vector{arm});
    // [end]
    // [eachdown]
    world.query<Global, const Local>().eachDown(
        world.hierarchy(), [](Global& global, const Local& local, const Global* parent) {
            global.x = local.x + (parent != nullptr ? parent->x : 0);
        });
    EXPECT_EQ(world.get<const Global>(hand).x, 13);
    // [end]
    // [cascade]
    world.clearParent(hand); // a root again
    world.destroy(body);     // and arm with it
    EXPECT_FALSE(world.alive(arm));
    EXPECT_TRUE(world.alive(hand));
    // [end]
}

TEST(Guide, Changed)
{
    World world;
    // [changed]
    std::vector<Entity> crowd(1000);
    world.createMany(crowd, Health{});

    const uint64_t seen = world.version(); // all up to now is known
    world.advance();                       // what follows is later
    world.get<Health>(crowd[7]).points = 1;
    static_cast<void>(world.get<const Health>(crowd[8])); // const: no mark

    std::vector<Entity> changed;
    world.query<Changed<Health>>().since(seen).each(
        [&](Entity entity) { changed.push_back(entity); });
    EXPECT_EQ(changed, std::vector{crowd[7]});
    // [end]
}

} // namespace game
