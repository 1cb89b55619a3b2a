// Disabled entities: skipped by every way to walk, unmoved, and remembered through all moves.
#include "runtime/ecs/command_buffer.h"
#include "tests/runtime/ecs/components.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace penumbra::ecs {

namespace {

bool before(Entity a, Entity b)
{
    return std::pair(a.index, a.generation) < std::pair(b.index, b.generation);
}
using Enabled = std::map<Entity, bool, decltype(&before)>;

// What each way to walk sees: the enabled ones, in one order.
template <class T>
void checkWalks(World& world, const Enabled& model)
{
    std::vector<Entity> each, segments;
    std::atomic<uint32_t> parallelRows = 0, parallelSegmentRows = 0;
    const auto query = world.query<T>();
    query.each([&](Entity entity, T&) { each.push_back(entity); });
    uint32_t ordinal = 0;
    query.eachSegment([&](Segment segment, auto column) {
        EXPECT_EQ(segment.ordinal, ordinal++);
        EXPECT_GT(segment.count, 0u);
        for (uint32_t i = 0; i < segment.count; ++i) {
            segments.push_back(segment.entities[i]);
            if constexpr (kLaneCount<T> == 1) {
                EXPECT_EQ(&column[i], world.tryGet<const T>(segment.entities[i]));
            }
        }
    });
    EXPECT_EQ(ordinal, query.segmentCount());
    query.parallelEach([&](Entity entity, T&) { parallelRows += model.at(entity) ? 1 : 1000000; });
    query.parallelEachSegment([&](Segment segment, auto) { parallelSegmentRows += segment.count; });
    uint32_t expected = 0, all = 0;
    for (const auto& [entity, enabled] : model)
        if (world.has<T>(entity)) {
            ++all;
            expected += enabled;
        }
    ASSERT_EQ(each.size(), expected);
    for (const Entity entity : each)
        ASSERT_TRUE(model.at(entity));
    ASSERT_EQ(segments, each);
    ASSERT_EQ(parallelRows, expected);
    ASSERT_EQ(parallelSegmentRows, expected);
    ASSERT_EQ(query.count(), expected);

    std::vector<Entity> changed;
    world.query<const T, Changed<T>>().each(
        [&](Entity entity, const T&) { changed.push_back(entity); });
    ASSERT_EQ(changed, each); // since 0: all of them
    uint32_t everyone = 0;
    world.query<const T, WithDisabled>().each([&](Entity, const T&) { ++everyone; });
    ASSERT_EQ(everyone, all);
    const auto withDisabled = world.query<const T, WithDisabled>();
    ASSERT_EQ(withDisabled.count(), all);
}

} // namespace

TEST(Enable, QueriesSkipWhatIsDisabled)
{
    World world;
    const Entity a = world.create(Health{1});
    const Entity b = world.create(Health{2});
    const Entity c = world.create(Health{4});
    const uint32_t archetypes = world.statistics().archetypes;
    world.setEnabled(b, false);
    uint32_t sum = 0;
    const auto add = [&](const Health& h) { sum += h.points; };
    world.query<const Health>().each(add);
    EXPECT_EQ(sum, 5u);
    sum = 0;
    world.query<const Health, WithDisabled>().each(add);
    EXPECT_EQ(sum, 7u);
    EXPECT_TRUE(world.isEnabled(a) && !world.isEnabled(b));
    EXPECT_EQ(world.get<Health>(b).points, 2u); // all else works
    EXPECT_EQ(world.statistics().archetypes, archetypes);
    EXPECT_EQ(world.statistics().disabled, 1u);
    world.setEnabled(b, false); // twice is once
    EXPECT_EQ(world.query<const Health>().count(), 2u);
    world.destroy(a); // c takes its row
    EXPECT_TRUE(world.isEnabled(c));
    world.destroy(b);
    const Entity d = world.create(Health{8});
    EXPECT_TRUE(world.isEnabled(d));
    EXPECT_EQ(world.query<const Health>().count(), 2u);
    EXPECT_EXIT(world.setEnabled(b, true), testing::ExitedWithCode(3), "is not alive");
}

TEST(Enable, SegmentsAreTheRunsBetween)
{
    World world;
    std::vector<Entity> entities(5000);
    world.createMany(entities, Position{}, Velocity{});
    for (const uint32_t i : {0u, 10u, 11u, 4999u})
        world.setEnabled(entities[i], false);
    std::vector<uint32_t> firsts;
    const auto query = world.query<Position, const Velocity>();
    query.eachSegment([&](Segment segment, Position*, Lanes<const Velocity>) {
        firsts.push_back(segment.entities[0].index);
    });
    ASSERT_EQ(firsts.size(), query.segmentCount());
    EXPECT_EQ(firsts[0], 1u);
    EXPECT_EQ(firsts[1], 12u);
    const World& view = world;
    const auto untouched = view.query<const Position, WithDisabled>().segmentCount();
    EXPECT_EQ(firsts.size(), untouched + 1u);
}

// A writer of what it can see marks nothing else.
TEST(Enable, DisabledRowsAreNotMarked)
{
    World world;
    std::vector<Entity> entities(100);
    world.createMany(entities, Health{1});
    world.setEnabled(entities[7], false);
    const uint64_t seen = world.version();
    world.advance();
    world.query<Health>().each([](Health& h) { h.points += 1; });
    std::vector<Entity> changed;
    const auto query = world.query<const Health, Changed<Health>, WithDisabled>().since(seen);
    query.each([&](Entity entity, const Health&) { changed.push_back(entity); });
    EXPECT_EQ(changed.size(), 99u);
    EXPECT_EQ(std::count(changed.begin(), changed.end(), entities[7]), 0);
    EXPECT_EQ(world.get<const Health>(entities[7]).points, 1u);
}

// Who skipped a row may have missed what changed meanwhile.
TEST(Enable, EnablingCountsAsAChange)
{
    World world;
    const Entity entity = world.create(Health{1});
    world.create(Health{2});
    world.setEnabled(entity, false);
    world.get<Health>(entity).points = 5;
    const uint64_t seen = world.version();
    world.advance();
    std::vector<Entity> changed;
    const auto look = [&] {
        changed.clear();
        world.query<const Health, Changed<Health>>().since(seen).each(
            [&](Entity e, const Health&) { changed.push_back(e); });
    };
    look();
    EXPECT_TRUE(changed.empty());
    world.setEnabled(entity, true);
    look();
    EXPECT_EQ(changed, std::vector{entity});
}

TEST(Enable, ReachesTheSubtreeOnDemand)
{
    World world;
    const Entity root = world.create(Health{});
    const Entity child = world.create(Health{}, Parent{root});
    const Entity leaf = world.create(Health{}, Parent{child});
    world.setEnabled(root, false);
    EXPECT_TRUE(world.isEnabled(child) && world.isEnabled(leaf));
    world.setEnabled(root, true);
    world.setEnabled(child, false, Reach::subtree);
    EXPECT_TRUE(world.isEnabled(root));
    EXPECT_FALSE(world.isEnabled(child) || world.isEnabled(leaf));
    EXPECT_TRUE(world.isEnabled(world.create(Parent{child}))); // what comes later is enabled
    CommandBuffer commands;
    commands.setEnabled(root, false, Reach::subtree);
    commands.setEnabled(leaf, true); // later, whatever entity was named first
    play(world, commands);
    EXPECT_TRUE(world.isEnabled(leaf));
    EXPECT_FALSE(world.isEnabled(root) || world.isEnabled(child));
}

TEST(Enable, CommandsKnowIt)
{
    World world;
    const Entity a = world.create(Health{1});
    const Entity gone = world.create(Health{1});
    world.destroy(gone);
    CommandBuffer commands;
    const Entity made = commands.create(Health{2});
    commands.setEnabled(made, false);
    commands.setEnabled(a, false);
    commands.add(a, Position{}); // moves as well
    commands.setEnabled(gone, false);
    EXPECT_EQ(play(world, commands).dropped, 1u);
    EXPECT_FALSE(world.isEnabled(a));
    EXPECT_EQ(world.query<const Health>().count(), 0u);
    const auto all = world.query<const Health, WithDisabled>();
    EXPECT_EQ(all.count(), 2u);
    commands.add(a, Velocity{}); // stays disabled
    play(world, commands);
    EXPECT_FALSE(world.isEnabled(a));
    commands.setEnabled(a, true);
    play(world, commands);
    EXPECT_TRUE(world.isEnabled(a));
}

// Random operations against a map: swap-removes, moves, bulk, commands, across segments.
TEST(Enable, FlagsStayWithTheirEntities)
{
    World world;
    Enabled model(&before);
    std::mt19937 random(11);
    std::vector<Entity> pool(9000);
    world.createMany(pool, Wide{}, Health{}, Velocity{}); // segments of few rows
    for (const Entity entity : pool)
        model[entity] = true;
    CommandBuffer commands;
    for (uint32_t round = 0; round < 20000; ++round) {
        const size_t at = random() % pool.size();
        const Entity entity = pool[at];
        switch (random() % 10) {
        case 0:
            if (pool.size() < 8500)
                break;
            world.destroy(entity);
            model.erase(entity);
            pool[at] = pool.back();
            pool.pop_back();
            break;
        case 1:
            model[pool.emplace_back(world.create(Health{1}, Velocity{}))] = true;
            break;
        case 2:
            world.add(entity, Position{});
            break;
        case 3:
            world.remove<Wide>(entity);
            break;
        case 4:
            commands.remove<Position>(entity);
            commands.add(pool[random() % pool.size()], Wide{});
            break;
        case 5:
        case 6:
            commands.setEnabled(entity, model[entity] = random() % 2 == 0);
            play(world, commands);
            break;
        default:
            world.setEnabled(entity, model[entity] = random() % 2 == 0);
        }
        if (round % 700 != 0)
            continue;
        play(world, commands);
        for (const auto& [e, enabled] : model)
            ASSERT_EQ(world.isEnabled(e), enabled) << round;
        checkWalks<Health>(world, model);
        checkWalks<Velocity>(world, model);
        checkWalks<Wide>(world, model);
        world.trim();
        if (HasFatalFailure() || HasNonfatalFailure())
            FAIL() << round;
    }
}

TEST(Enable, EachDownSkips)
{
    World world;
    std::vector<Entity> chain;
    for (uint32_t i = 0; i < 200; ++i)
        chain.push_back(i == 0 ? world.create(Health{1}, Position{})
                               : world.create(Health{1}, Position{}, Parent{chain[i - 1]}));
    for (const size_t i : {0, 5, 6, 199})
        world.setEnabled(chain[i], false);
    world.advance();
    const uint64_t before = world.version() - 1;
    const auto walk = [&](auto query) {
        uint32_t rows = 0;
        query.eachDown(world.hierarchy(), [&](Health& health, const Health* parent) {
            health.points = parent != nullptr ? parent->points + 1 : 10;
            ++rows;
        });
        return rows;
    };
    EXPECT_EQ(walk(world.query<Health>()), 196u);
    EXPECT_EQ(world.get<const Health>(chain[0]).points, 1u);
    EXPECT_EQ(world.get<const Health>(chain[1]).points, 2u); // the value that its parent has
    EXPECT_EQ(world.get<const Health>(chain[4]).points, 5u);
    EXPECT_EQ(world.get<const Health>(chain[7]).points, 2u);
    uint32_t changed = 0; // no mark on what was skipped
    world.query<const Health, Changed<Health>, WithDisabled>().since(before).each(
        [&](const Health&) { ++changed; });
    EXPECT_EQ(changed, 196u);
    EXPECT_EQ(walk(world.query<Health, WithDisabled>()), 200u);
    EXPECT_EQ(world.get<const Health>(chain[199]).points, 209u);
}

// Moves of many at once take it along.
TEST(Enable, BulkMovesKeepIt)
{
    World world;
    std::vector<Entity> entities(1000);
    world.createMany(entities, Position{});
    for (uint32_t i = 0; i < 1000; i += 3)
        world.setEnabled(entities[i], false);
    std::vector<Entity> some;
    for (uint32_t i = 0; i < 1000; i += 2)
        some.push_back(entities[i]);
    world.addMany(some, Health{1});
    world.removeMany<Position>(std::span(some).first(100));
    world.destroyMany(std::span(some).last(100));
    uint32_t enabled = 0;
    for (uint32_t i = 0; i < 1000; ++i) {
        if (!world.alive(entities[i]))
            continue;
        EXPECT_EQ(world.isEnabled(entities[i]), i % 3 != 0);
        enabled += i % 3 != 0;
    }
    EXPECT_EQ(world.query<>().count(), enabled);
}

} // namespace penumbra::ecs
