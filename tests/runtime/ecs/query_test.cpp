#include "runtime/ecs/query.h"
#include "tests/runtime/ecs/components.h"

#include <gtest/gtest.h>

#include <numeric>

namespace penumbra::ecs {

TEST(Query, FindsWithWithoutAndOptional)
{
    World world;
    const Entity a = world.create(Position{1, 0, 0});
    const Entity b = world.create(Position{2, 0, 0}, Velocity{1, 0, 0});
    const Entity c = world.create(Position{3, 0, 0}, Frozen{}, Health{30});
    world.create(Velocity{});

    std::vector<Entity> found;
    const auto collect = [&](Entity entity, const Position&) { found.push_back(entity); };
    world.query<const Position>().each(collect);
    EXPECT_EQ(found, (std::vector{a, b, c})); // archetypes in the order they were made
    found.clear();
    world.query<const Position, Without<Frozen>>().each(collect);
    EXPECT_EQ(found, (std::vector{a, b}));
    found.clear();
    world.query<const Position, With<Frozen>>().each(collect);
    EXPECT_EQ(found, (std::vector{c}));

    float sum = 0;
    world.query<const Position, Maybe<const Velocity>, Maybe<Health>>().each(
        [&](const Position& p, const Velocity* v, Health* h) {
            sum += p.x + (v != nullptr ? 10 * v->x : 0);
            if (h != nullptr)
                h->points += 1;
        });
    EXPECT_EQ(sum, 1 + 2 + 3 + 10);
    EXPECT_EQ(world.get<const Health>(c).points, 31u);
}

TEST(Query, SeesArchetypesMadeLater)
{
    World world;
    EXPECT_EQ(world.query<const Position>().count(), 0u);
    world.create(Position{}, Health{});
    EXPECT_EQ(world.query<const Position>().count(), 1u);
    world.create(Position{}, Wide{});
    EXPECT_EQ(world.query<const Position>().count(), 2u);
}

// Lanes are loaded and stored around the call: a split component reads like any other.
TEST(Query, WritesThroughLanes)
{
    World world;
    std::vector<Entity> entities(40000); // several blocks
    world.createMany(entities, Position{1, 2, 3}, Velocity{0, 0, 0});
    world.query<Velocity, const Position>().each([](Entity entity, Velocity& v, const Position& p) {
        v = {p.x + static_cast<float>(entity.index), p.y, p.z};
    });
    world.query<Maybe<Velocity>>().each([](Velocity* v) {
        if (v != nullptr)
            v->y += 1;
    });
    for (const Entity entity : entities)
        ASSERT_EQ(world.value<Velocity>(entity),
                  (Velocity{1 + static_cast<float>(entity.index), 3, 3}));
}

TEST(Query, SegmentsCoverEachRowOnce)
{
    World world;
    std::vector<Entity> entities(40000); // several blocks
    world.createMany(entities, Position{}, Velocity{1, 2, 3});
    world.create(Position{}, Velocity{1, 2, 3}, Frozen{});

    uint32_t rows = 0;
    uint32_t segments = 0;
    const auto query = world.query<Position, const Velocity>();
    query.eachSegment([&](Segment segment, Position* p, Lanes<const Velocity> v) {
        EXPECT_EQ(segment.ordinal, segments++);
        for (uint32_t i = 0; i < segment.count; ++i) {
            EXPECT_EQ(&p[i], world.tryGet<const Position>(segment.entities[i]));
            p[i] = {v[0][i], v[1][i], v[2][i]};
        }
        rows += segment.count;
    });
    EXPECT_EQ(rows, entities.size() + 1);
    EXPECT_EQ(segments, query.segmentCount());
    for (const Entity entity : entities)
        ASSERT_EQ(world.get<const Position>(entity), (Position{1, 2, 3}));
}

// Segment ordinals make a reduction independent of who computed what: the same bits every time.
TEST(Query, ParallelReductionHasTheBitsOfTheSerialOne)
{
    World world;
    std::vector<Position> positions(50000);
    for (size_t i = 0; i < positions.size(); ++i)
        positions[i].x = 1.0f / static_cast<float>(i + 1);
    std::vector<Entity> entities(positions.size());
    world.createMany(entities, std::span(positions));

    const auto query = world.query<const Position>();
    const auto sum = [&](bool parallel) {
        std::vector<float> parts(query.segmentCount());
        const auto add = [&](Segment segment, const Position* p) {
            for (uint32_t i = 0; i < segment.count; ++i)
                parts[segment.ordinal] += p[i].x;
        };
        parallel ? query.parallelEachSegment(add) : query.eachSegment(add);
        return std::accumulate(parts.begin(), parts.end(), 0.0f);
    };
    const float serial = sum(false);
    for (int i = 0; i < 20; ++i)
        ASSERT_EQ(sum(true), serial);
}

TEST(Query, ParallelEachVisitsEachRowOnce)
{
    World world;
    std::vector<Entity> entities(50000);
    world.createMany(entities, Health{0}, Velocity{});
    world.query<Health, Velocity>().parallelEach([](Entity entity, Health& h, Velocity& v) {
        h.points += entity.index;
        v.z += 1;
    });
    for (const Entity entity : entities) {
        ASSERT_EQ(world.get<const Health>(entity).points, entity.index);
        ASSERT_EQ(world.value<Velocity>(entity).z, 1);
    }
}

TEST(Query, ReadsAConstWorld)
{
    World world;
    world.create(Health{3});
    const World& view = world;
    uint32_t points = 0;
    view.query<const Health>().each([&](const Health& h) { points += h.points; });
    EXPECT_EQ(points, 3u);
}

} // namespace penumbra::ecs
