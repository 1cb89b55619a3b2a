// Samples of docs/ecs.md: entities, components, queries. See guide_components.h.
#include "tests/runtime/ecs/guide_components.h"

#include <gtest/gtest.h>

namespace game {

TEST(Guide, First)
{
    // [first]
    World world;
    const Entity ball = world.create(Position{0, 2, 0}, Velocity{1, 0, 0});
    world.create(Position{5, 0, 0}); // no Velocity: the query below passes it by

    const float dt = 0.5f;
    world.query<Position, const Velocity>().each([&](Position& p, const Velocity& v) {
        p.x += v.x * dt;
        p.y += v.y * dt;
        p.z += v.z * dt;
    });
    EXPECT_EQ(world.get<const Position>(ball).x, 0.5f);
    // [end]
}

TEST(Guide, Create)
{
    World world;
    // [create]
    const Entity one = world.create(Position{1, 0, 0}, Velocity{}, Frozen{}); // one move, not three

    std::vector<Entity> crowd(1000);
    world.createMany(crowd, Position{}, Health{50}); // the same values for all

    std::vector<Position> places(crowd.size());
    std::vector<Entity> others(crowd.size());
    world.createMany(others, std::span<const Position>(places), Frozen{}); // one value for each
    std::vector<Entity> more(crowd.size());
    world.createMany(more, [](uint32_t i) { return Health{i % 10}; }); // the same, made in place
    // [end]
    EXPECT_TRUE(world.has<Frozen>(one));
    EXPECT_EQ(world.count(), 3001u);
    EXPECT_EQ(world.get<const Health>(crowd[999]).points, 50u);
    EXPECT_EQ(world.get<const Health>(more[999]).points, 9u);
}

TEST(Guide, Change)
{
    World world;
    const Entity ball = world.create(Position{1, 0, 0});
    std::vector<Entity> crowd(100);
    world.createMany(crowd, Position{});
    // [change]
    world.add(ball, Velocity{0, 1, 0}, Health{}); // both in one move; overwrites what is there
    world.set(ball, Health{80});                  // must be there
    world.remove<Velocity, Frozen>(ball);         // Frozen is not there: ignored
    world.addMany(crowd, Velocity{1, 0, 0});      // neighbours in one archetype move together
    world.removeMany<Velocity>(crowd);

    const Health* health = world.tryGet<const Health>(ball); // null if absent
    EXPECT_EQ(health->points, 80u);
    world.get<Position>(ball).x = 7; // must be there; marks Position as changed
    EXPECT_FALSE(world.has<Velocity>(ball));
    // [end]
    // [destroy]
    world.destroy(ball);
    EXPECT_FALSE(world.alive(ball));
    const Entity next = world.create(); // takes the index of ball, with the next generation
    EXPECT_EQ(next.index, ball.index);
    EXPECT_NE(next, ball);
    world.destroyMany(crowd);
    // [end]
    EXPECT_EQ(world.count(), 1u);
}

TEST(Guide, LanesAndOwners)
{
    World world;
    // [lanevalue]
    const Entity wheel = world.create(Spin{1, 2, 3}, Path{{{0, 0, 0}, {4, 0, 0}}});
    Spin spin = world.value<Spin>(wheel); // a copy: a split component has no address
    spin.z = 0;
    world.set(wheel, spin);
    world.query<Spin>().each([](Spin& s) { s.x *= 0.5f; }); // loaded before, stored after the call
    world.get<Path>(wheel).points.push_back({8, 0, 0});     // an owning one is like any other
    // [end]
    EXPECT_EQ(world.value<Spin>(wheel).x, 0.5f);
    EXPECT_EQ(world.value<Spin>(wheel).z, 0);
    EXPECT_EQ(world.get<const Path>(wheel).points.size(), 3u);
}

TEST(Guide, Terms)
{
    World world;
    const Entity ball = world.create(Position{}, Velocity{1, 0, 0}, Health{10});
    world.create(Position{}, Velocity{1, 0, 0}, Frozen{});
    world.create(Position{});
    // [terms]
    uint32_t visited = 0;
    world.query<Position, Maybe<const Velocity>, Without<Frozen>>().each(
        [&](Entity, Position& p, const Velocity* v) { // Entity first, if wanted
            p.x += v != nullptr ? v->x : 0;
            ++visited;
        });
    EXPECT_EQ(visited, 2u);
    EXPECT_EQ((world.query<With<Frozen>, With<Position>>().count()), 1u);
    // [end]
    EXPECT_EQ(world.get<const Position>(ball).x, 1);
}

TEST(Guide, Segments)
{
    World world;
    std::vector<Entity> wheels(5000);
    world.createMany(wheels, Spin{1, 2, 3}, Health{3});
    // [segments]
    world.query<Spin>().eachSegment([](Segment segment, Lanes<Spin> spin) {
        float* __restrict x = spin[0]; // [segment.count]; plain T: a T* here
        for (uint32_t i = 0; i < segment.count; ++i)
            x[i] *= 0.5f;
    });
    // [end]
    // [reduce]
    const auto query = world.query<const Health>();
    std::vector<uint64_t> parts(query.segmentCount());
    query.parallelEachSegment([&](Segment segment, const Health* health) {
        for (uint32_t i = 0; i < segment.count; ++i)
            parts[segment.ordinal] += health[i].points; // a place per segment, added in order below
    });
    uint64_t sum = 0;
    for (const uint64_t part : parts)
        sum += part;
    EXPECT_EQ(sum, 15000u);
    // [end]
    EXPECT_EQ(world.value<Spin>(wheels[4999]).x, 0.5f);
}

TEST(Guide, Enabled)
{
    World world;
    // [enabled]
    const Entity lamp = world.create(Position{}), bulb = world.create(Position{}, Parent{lamp});
    world.setEnabled(lamp, false, Reach::subtree); // bulb too; nothing moves in memory
    EXPECT_FALSE(world.isEnabled(bulb));
    EXPECT_EQ(world.query<const Position>().count(), 0u);
    EXPECT_EQ((world.query<const Position, WithDisabled>().count()), 2u);
    world.get<Position>(bulb).y = 1; // direct access works as before
    world.setEnabled(bulb, true);    // counts as a change of all its components
    // [end]
    EXPECT_EQ(world.query<const Position>().count(), 1u);
}

TEST(Guide, Singletons)
{
    World world;
    // [singletons]
    world.setSingleton(Gravity{1.62f});
    world.singleton<Gravity>().metresPerSecond2 *= 2;
    const World& view = world;
    EXPECT_EQ(view.singleton<Gravity>().metresPerSecond2, 3.24f); // const: marks nothing
    EXPECT_FALSE(view.hasSingleton<Lamp>());
    // [end]
}

} // namespace game
