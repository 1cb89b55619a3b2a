// Corners where terms meet structural change.
#include "runtime/ecs/command_buffer.h"
#include "tests/runtime/ecs/components.h"

#include <gtest/gtest.h>

namespace penumbra::ecs {

namespace {

template <class... Terms, class... Arguments>
std::vector<Entity> found(const Query<Terms...>& query, void (*)(Arguments...))
{
    std::vector<Entity> entities;
    query.each([&](Entity entity, Arguments...) { entities.push_back(entity); });
    return entities;
}
void noArguments() {}
void healthArgument(const Health&) {}

} // namespace

// The cache of a query is older than every archetype that it comes to match, or not to match.
TEST(QueryCorner, CachesMeetLaterArchetypes)
{
    World world;
    const auto with = [&] {
        return found(world.query<With<Frozen>, Without<Velocity>>(), noArguments);
    };
    const auto maybe = [&] {
        uint32_t present = 0, absent = 0;
        world.query<Maybe<const Velocity>, With<Frozen>>().each(
            [&](const Velocity* v) { ++(v != nullptr ? present : absent); });
        return std::pair(present, absent);
    };
    EXPECT_TRUE(with().empty());
    EXPECT_EQ(maybe(), std::pair(0u, 0u));
    const Entity a = world.create(Frozen{});
    EXPECT_EQ(with(), std::vector{a});
    const Entity b = world.create(Frozen{}, Velocity{});
    EXPECT_EQ(with(), std::vector{a});
    EXPECT_EQ(maybe(), std::pair(1u, 1u));
    world.remove<Velocity>(b); // back into one that is known
    EXPECT_EQ(with(), (std::vector{a, b}));
    CommandBuffer commands;
    const Entity made = commands.create(Frozen{}, Health{}); // made by playback
    static_cast<void>(made);
    commands.add(a, Velocity{});
    play(world, commands);
    EXPECT_EQ(with().size(), 2u);
    EXPECT_EQ(maybe(), std::pair(1u, 2u));
    world.remove<Frozen>(a);
    EXPECT_EQ(maybe(), std::pair(0u, 2u));
}

// What a query remembers of where columns lie does not outlive it: blocks grow, become several, are
// given back; rows are disabled.
TEST(QueryCorner, FindColumnsThatMoved)
{
    World world;
    std::vector<Entity> entities;
    const auto create = [&](uint32_t count) {
        for (uint32_t i = 0; i < count; ++i) {
            const auto x = static_cast<float>(entities.size());
            entities.push_back(world.create(Position{x, 0, 0}, Velocity{0, x, 0}));
        }
    };
    const auto expectAll = [&](const Query<Position, const Velocity, Maybe<const Health>>& query) {
        size_t at = 0;
        query.each([&](Entity entity, Position& p, const Velocity& v, const Health* health) {
            ASSERT_LT(at, entities.size());
            ASSERT_EQ(entity, entities[at]);
            ASSERT_EQ(p.x, v.y);
            ASSERT_EQ(p.x, static_cast<float>(entity.index));
            ASSERT_EQ(health, nullptr);
            ++at;
        });
        EXPECT_EQ(at, entities.size());
    };
    create(1);
    auto again = world.query<Position, const Velocity, Maybe<const Health>>();
    while (entities.size() < 20000) {
        create(static_cast<uint32_t>(entities.size() / 3 + 1));
        expectAll(again); // made before the rows
        expectAll(world.query<Position, const Velocity, Maybe<const Health>>());
    }
    while (entities.size() > 5) {
        world.destroy(entities.back());
        entities.pop_back();
    }
    expectAll(again);
    world.trim();
    expectAll(again);
    const Entity hidden = entities.back();
    entities.pop_back();
    world.setEnabled(hidden, false);
    expectAll(again);
    world.setEnabled(hidden, true);
    entities.push_back(hidden);
    expectAll(again);
    while (!entities.empty()) { // rows go and come without anything moving
        world.destroy(entities.back());
        entities.pop_back();
        expectAll(again);
    }
    create(3);
    expectAll(again);
}

// As documented: a Query that is kept sees new rows, but new archetypes only once it is asked
// again.
TEST(QueryCorner, KeptQueriesSeeRowsOfKnownArchetypes)
{
    World world;
    world.create(Health{});
    const auto kept = world.query<const Health>();
    world.create(Health{});
    EXPECT_EQ(kept.count(), 2u);
    world.create(Health{}, Frozen{});
    EXPECT_EQ(kept.count(), 2u);
    EXPECT_EQ(world.query<const Health>().count(), 3u);
    EXPECT_EQ(kept.count(), 3u); // they share the cache
}

TEST(QueryCorner, ChangedAfterRemoveAndAdd)
{
    World world;
    const Entity a = world.create(Health{1});
    const Entity b = world.create(Health{2});
    uint64_t seen = 0;
    const auto look = [&] {
        seen = world.version();
        world.advance();
    };
    const auto changed = [&] {
        return found(world.query<const Health, Changed<Health>>().since(seen), healthArgument);
    };
    look();
    EXPECT_TRUE(changed().empty());
    world.remove<Health>(a); // b takes its row: moved, so it counts
    EXPECT_EQ(changed(), std::vector{b});
    look();
    world.add(a, Health{1}); // the same value, but it is new
    EXPECT_EQ(changed(), std::vector{a});
    look();
    EXPECT_TRUE(changed().empty());
    world.remove<Health>(a);
    world.add(a, Health{3});
    world.set(a, Health{4});
    EXPECT_EQ(changed(), std::vector{a}); // once
    look();
    CommandBuffer commands;
    commands.remove<Health>(a);
    commands.add(a, Health{4}); // merged: it never leaves
    play(world, commands);
    EXPECT_EQ(changed(), std::vector{a});
    look();
    world.add(b, Frozen{}); // both move: readers may keep things by row
    EXPECT_EQ(changed(), (std::vector{a, b}));
    EXPECT_EQ(found(world.query<const Health, Changed<Health>, Without<Frozen>>().since(seen),
                    healthArgument),
              std::vector{a});
}

TEST(QueryCorner, MaybeWithLanes)
{
    World world;
    const Entity with = world.create(Health{1}, Velocity{1, 2, 3});
    const Entity without = world.create(Health{2});
    uint32_t segments = 0, absent = 0;
    world.query<const Health, Maybe<Velocity>>().eachSegment(
        [&](Segment segment, const Health*, Lanes<Velocity> v) {
            ++segments;
            if (v[0] == nullptr) {
                EXPECT_EQ(segment.entities[0], without);
                EXPECT_TRUE(v[1] == nullptr && v[2] == nullptr);
                ++absent;
            } else {
                EXPECT_EQ(segment.entities[0], with);
                v[1][0] = 20;
            }
        });
    EXPECT_EQ(segments, 2u);
    EXPECT_EQ(absent, 1u);
    world.query<Maybe<const Velocity>, Maybe<Health>>().parallelEach(
        [&](const Velocity* v, Health* h) { h->points = v != nullptr ? 10 : 11; });
    EXPECT_EQ(world.value<Velocity>(with), (Velocity{1, 20, 3}));
    EXPECT_EQ(world.get<const Health>(with).points, 10u);
    EXPECT_EQ(world.get<const Health>(without).points, 11u);

    const uint64_t seen = world.version();
    world.advance();
    world.query<Maybe<const Velocity>>().each([](const Velocity*) {}); // reads
    const auto changed = world.query<Changed<Velocity>>().since(seen);
    EXPECT_TRUE(found(changed, noArguments).empty());
    world.query<Maybe<Velocity>>().each([](Velocity* v) { // writes, where there is something
        if (v != nullptr)
            v->x = 5;
    });
    EXPECT_EQ(found(changed, noArguments), std::vector{with});
    EXPECT_EQ(world.value<Velocity>(with).x, 5);
}

TEST(QueryCorner, TagsAndSingletons)
{
    World world;
    const Entity holder = world.setSingleton(Gravity{1});
    EXPECT_EQ(world.query<const Gravity>().count(), 1u); // an entity like any other
    world.add(holder, Frozen{});                         // moves it
    EXPECT_EQ(world.singleton<const Gravity>().metresPerSecond2, 1);
    world.setEnabled(holder, false);
    EXPECT_EQ(world.query<const Gravity>().count(), 0u);
    EXPECT_EQ(world.singleton<const Gravity>().metresPerSecond2, 1);
    EXPECT_TRUE(found(world.query<With<Frozen>>(), noArguments).empty());
    EXPECT_EQ(found(world.query<With<Frozen>, WithDisabled>(), noArguments), std::vector{holder});
    world.add(holder, Frozen{}); // a tag again: nothing moves
    world.remove<Frozen>(holder);
    EXPECT_FALSE(world.has<Frozen>(holder));
    world.destroy(holder);
    world.create(Health{}); // takes the index
    EXPECT_FALSE(world.hasSingleton<Gravity>());
    EXPECT_EXIT(static_cast<void>(world.singleton<Gravity>()), testing::ExitedWithCode(3),
                "no singleton test.Gravity");
    EXPECT_NE(world.setSingleton(Gravity{2}), holder);
}

} // namespace penumbra::ecs
