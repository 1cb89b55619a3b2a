// What Changed<> reports: nothing that was read only, everything that was written, and for
// components that opt in, no row beside those.
#include "runtime/ecs/query.h"
#include "tests/runtime/ecs/components.h"

#include <gtest/gtest.h>

namespace penumbra::ecs {

namespace {

constexpr uint32_t kCount = 20000;

struct Fixture : testing::Test {
    Fixture() : entities(kCount)
    {
        world.createMany(entities, Position{}, Velocity{}, Health{});
        look();
    }

    // From now on, only later changes are reported.
    void look()
    {
        seen = world.version();
        world.advance();
    }

    template <class T>
    std::vector<Entity> changed()
    {
        std::vector<Entity> found;
        world.query<const T, Changed<T>>().since(seen).each(
            [&](Entity entity, const T&) { found.push_back(entity); });
        return found;
    }

    World world;
    std::vector<Entity> entities;
    uint64_t seen = 0;
};

} // namespace

using Change = Fixture;

TEST_F(Change, ReadingMarksNothing)
{
    float sum = 0;
    world.query<const Position, const Health, Maybe<const Velocity>>().each(
        [&](const Position& p, const Health&, const Velocity*) { sum += p.x; });
    world.query<const Position>().eachSegment([](Segment, const Position*) {});
    static_cast<void>(world.get<const Position>(entities[0]));
    static_cast<void>(world.tryGet<const Health>(entities[0]));
    static_cast<void>(world.value<Velocity>(entities[0]));
    static_cast<void>(std::as_const(world).get<Health>(entities[0]));
    EXPECT_TRUE(changed<Position>().empty());
    EXPECT_TRUE(changed<Velocity>().empty());
    EXPECT_TRUE(changed<Health>().empty());
}

TEST_F(Change, EachMarksWhatItMayWrite)
{
    world.query<Position, const Health>().each([](Position&, const Health&) {});
    EXPECT_EQ(changed<Position>().size(), kCount);
    EXPECT_TRUE(changed<Health>().empty());
    look();
    world.query<Maybe<Health>>().parallelEach([](Health*) {});
    EXPECT_EQ(changed<Health>().size(), kCount);
    look();
    world.query<Velocity>().eachSegment([](Segment, Lanes<Velocity>) {});
    EXPECT_EQ(changed<Velocity>().size(), kCount);
    look();
    EXPECT_TRUE(changed<Velocity>().empty());
}

TEST_F(Change, OneWriteReportsItsSegmentOrItsRow)
{
    const Entity written = entities[kCount / 2];
    world.get<Position>(written).x = 1;
    world.get<Health>(written).points = 1;
    const std::vector<Entity> segment = changed<Position>();
    EXPECT_NE(std::find(segment.begin(), segment.end(), written), segment.end());
    EXPECT_LT(segment.size(), 1000u);
    EXPECT_EQ(changed<Health>(), std::vector{written});
    look();
    world.set(written, Velocity{1, 2, 3});
    EXPECT_FALSE(changed<Velocity>().empty());
    EXPECT_TRUE(changed<Health>().empty());
}

TEST_F(Change, RowsAddUpAndFallAway)
{
    for (uint32_t frame = 0; frame < 10; ++frame) {
        std::vector<Entity> expected;
        for (uint32_t i = frame; i < kCount; i += 97) {
            world.get<Health>(entities[i]).points = frame;
            expected.push_back(entities[i]);
        }
        ASSERT_EQ(changed<Health>(), expected) << frame;
        look();
    }
}

// A reader that looks every few frames still gets everything; perhaps more, never less.
TEST_F(Change, LateReadersMissNothing)
{
    const uint64_t long_ago = seen;
    std::vector<Entity> written;
    for (uint32_t frame = 0; frame < 5; ++frame) {
        written.push_back(entities[1000 + frame * 3]);
        world.get<Health>(written.back()).points = 1;
        look();
    }
    seen = long_ago;
    const std::vector<Entity> found = changed<Health>();
    for (const Entity entity : written)
        EXPECT_NE(std::find(found.begin(), found.end(), entity), found.end());
}

// Two frames that wrote are told apart row by row, wherever in the archetype they wrote; of the
// frames before, the segments.
TEST_F(Change, ReadersTwoFramesBehindGetRowsThenSegments)
{
    const uint64_t before = seen;
    const std::vector<Entity> written{entities[10], entities[kCount / 2], entities[kCount - 10]};
    for (const Entity entity : written) {
        world.get<Health>(entity).points = 1;
        look();
        look(); // frames that write nothing count for nothing
        seen = before;
        const std::vector<Entity> found = changed<Health>();
        if (entity != written.back()) {
            EXPECT_EQ(found,
                      std::vector(written.begin(), written.begin() + 1 + (entity != written[0])));
            continue;
        }
        for (const Entity expected : written)
            EXPECT_NE(std::find(found.begin(), found.end(), expected), found.end());
        EXPECT_GT(found.size(), 1000u); // three segments, whole
        EXPECT_LT(found.size(), kCount / 4);
    }
}

// The first write of a walk begins a frame: it visits what changed before, rows of two frames one
// by one, on one thread and on several.
TEST_F(Change, WalksThatBeginAFrameVisitWhatChangedBefore)
{
    for (uint32_t frame = 0; frame < 24; ++frame) {
        const uint64_t before = seen;
        std::vector<Entity> written;
        for (uint32_t i = frame; i < kCount; i += 61) {
            world.get<Health>(entities[i]).points = frame;
            written.push_back(entities[i]);
            if (i > kCount / 2 && i <= kCount / 2 + 61)
                look(); // the rest is of the next frame
        }
        look();
        const auto query = world.query<Health, Changed<Health>>().since(before);
        if (frame % 2 == 0)
            query.each([](Health& h) { h.points += 1000; });
        else
            query.parallelEach([](Health& h) { h.points += 1000; });
        ASSERT_EQ(changed<Health>(), written) << frame;
        for (const Entity entity : written)
            ASSERT_EQ(world.get<const Health>(entity).points, 1000u + frame);
        look();
    }
}

namespace {

struct Large { // few rows to a segment
    static constexpr std::string_view kName = "test.Large";
    static constexpr bool kRowChanges = true;
    std::array<uint32_t, 128> values{};
};

} // namespace

TEST(ChangeOfLarge, RowsOfSegmentsBelowAWordAreToldApart)
{
    World world;
    std::vector<Entity> entities(1000);
    world.createMany(entities, Large{});
    for (uint32_t frame = 0; frame < 5; ++frame) {
        const uint64_t seen = world.version();
        world.advance();
        std::vector<Entity> written;
        for (uint32_t i = frame; i < entities.size(); i += 13) {
            world.get<Large>(entities[i]).values[0] = frame;
            written.push_back(entities[i]);
        }
        std::vector<Entity> found;
        world.query<const Large, Changed<Large>>().since(seen).each(
            [&](Entity entity, const Large&) { found.push_back(entity); });
        ASSERT_EQ(found, written) << frame;
    }
    uint64_t seen = world.version();
    world.advance();
    world.query<Large>().each([](Large& large) { ++large.values[1]; });
    uint32_t rows = 0;
    world.query<const Large, Changed<Large>>().since(seen).each([&](const Large&) { ++rows; });
    EXPECT_EQ(rows, entities.size());
}

// What trim() gives back comes again, and counts as changed.
TEST(ChangeOfNew, CountsAfterTrim)
{
    World world;
    std::vector<Entity> entities(20000);
    world.createMany(entities, Health{}, Position{});
    while (entities.size() > 3) {
        world.destroy(entities.back());
        entities.pop_back();
    }
    world.trim();
    world.advance();
    const uint64_t seen = world.version() - 1;
    std::vector<Entity> made(20000 - 3);
    world.createMany(made, Health{}, Position{});
    uint32_t health = 0, positions = 0;
    world.query<const Health, Changed<Health>>().since(seen).each([&](const Health&) { ++health; });
    world.query<const Position, Changed<Position>>().since(seen).each(
        [&](const Position&) { ++positions; });
    EXPECT_EQ(health, made.size());
    EXPECT_EQ(positions, 20000u); // the first segment whole

    const uint64_t start = world.version(); // all within one version
    world.advance();
    const Entity first = world.create(Health{}, Velocity{});
    world.destroy(first);
    world.trim();
    const Entity second = world.create(Health{}, Velocity{});
    uint32_t again = 0;
    world.query<const Health, With<Velocity>, Changed<Health>>().since(start).each(
        [&](Entity entity, const Health&) { again += entity == second; });
    EXPECT_EQ(again, 1u);
}

TEST_F(Change, FilteredWritesMarkOnlyTheRowsVisited)
{
    world.get<Health>(entities[5]).points = 1;
    const uint64_t before = seen;
    look();
    world.query<Health, Changed<Health>>().since(before).each([](Health& h) { h.points += 1; });
    EXPECT_EQ(world.get<const Health>(entities[5]).points, 2u);
    EXPECT_EQ(changed<Health>(), std::vector{entities[5]});
}

TEST_F(Change, AnyOfSeveralPasses)
{
    world.get<Health>(entities[1]).points = 1;
    world.get<Health>(entities[kCount - 1]).points = 1;
    uint32_t rows = 0;
    world.query<const Health, Changed<Health>, Changed<Velocity>>().since(seen).each(
        [&](const Health&) { ++rows; });
    EXPECT_EQ(rows, 2u);
}

// A row that is new or has moved counts as changed: its reader may keep things by row.
TEST_F(Change, NewAndMovedRowsCount)
{
    const Entity created = world.create(Health{1});
    EXPECT_EQ(changed<Health>(), std::vector{created});
    look();
    world.add(entities[7], Frozen{});
    const std::vector<Entity> found = changed<Health>();
    EXPECT_EQ(found, (std::vector{entities.back(), entities[7]})); // the gap's new row, the moved
    look();
    world.destroy(entities[8]);
    EXPECT_EQ(changed<Health>(), std::vector{entities[kCount - 2]});
}

// create() asks little of rows that follow each other: none of them goes unmarked, whatever frames
// begin and rows leave in between.
TEST(ChangeOfNew, CountsOneByOneInEveryFrame)
{
    World world;
    std::vector<Entity> entities;
    for (uint32_t frame = 0; frame < 24; ++frame) {
        const uint64_t seen = world.version();
        world.advance();
        const size_t leaving = frame % 3 == 2 ? entities.size() / 2 + 100 : frame % 2 * 7;
        for (size_t i = 0; i < leaving && !entities.empty(); ++i) {
            world.destroy(entities.back());
            entities.pop_back();
        }
        if (frame % 4 == 3)
            world.trim();
        std::vector<Entity> made;
        for (uint32_t i = 0; i < 500 + frame * 97; ++i) {
            const auto x = static_cast<float>(entities.size());
            made.push_back(world.create(Velocity{x, 0, 1}, Position{0, x, 0}, Frozen{}));
            entities.push_back(made.back());
        }
        std::vector<Entity> found;
        world.query<const Position, const Velocity, Changed<Position>>().since(seen).each(
            [&](Entity entity, const Position& p, const Velocity& v) {
                ASSERT_EQ(p.y, v.x);
                ASSERT_EQ(v.z, 1);
                found.push_back(entity);
            });
        ASSERT_GE(found.size(), made.size()) << frame; // rows lie in the order of creation
        EXPECT_TRUE(std::equal(made.begin(), made.end(), found.end() - made.size())) << frame;
        EXPECT_EQ(world.query<const Velocity>().count(), entities.size());
        for (const Entity entity : entities)
            ASSERT_EQ(world.value<Velocity>(entity).x, world.get<const Position>(entity).y);
    }
}

} // namespace penumbra::ecs
