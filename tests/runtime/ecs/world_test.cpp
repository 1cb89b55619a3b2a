#include "runtime/ecs/world.h"
#include "tests/runtime/ecs/components.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <random>

namespace penumbra::ecs {

namespace {

struct PositionTwin { // the same name as Position, another layout
    static constexpr std::string_view kName = Position::kName;
    double x = 0;
};

struct External { // stands for a type from a library
    int value = 0;
};

} // namespace

template <>
struct ComponentTraits<External> {
    static constexpr std::string_view kName = "test.External";
    static constexpr bool kRowChanges = false;
};

TEST(Component, IdComesFromTheName)
{
    EXPECT_EQ(findComponent("test.Position"), componentId<Position>());
    EXPECT_EQ(findComponent("test.NoSuchThing"), kNone);
    EXPECT_EQ(componentInfo(componentId<Velocity>()).laneCount, 3u);
    EXPECT_EQ(componentInfo(componentId<Frozen>()).bytes, 0u);
    EXPECT_EQ(componentInfo(componentId<External>()).name, "test.External");
    Gravity gravity{0};
    componentInfo(componentId<Gravity>()).construct(&gravity);
    EXPECT_EQ(gravity.metresPerSecond2, 9.81f);
    static_cast<void>(componentId<Position>());
    EXPECT_EXIT(componentId<PositionTwin>(), testing::ExitedWithCode(3), "two layouts");
}

TEST(World, CreatesWithAllComponents)
{
    World world;
    const Entity entity = world.create(Position{1, 2, 3}, Velocity{4, 5, 6}, Frozen{});
    EXPECT_TRUE(world.alive(entity));
    EXPECT_EQ(world.get<const Position>(entity), (Position{1, 2, 3}));
    EXPECT_EQ(world.value<Velocity>(entity), (Velocity{4, 5, 6}));
    EXPECT_TRUE(world.has<Frozen>(entity));
    EXPECT_FALSE(world.has<Health>(entity));
    EXPECT_EQ(world.tryGet<Health>(entity), nullptr);
    const Entity bare = world.create();
    EXPECT_TRUE(world.components(bare).isEmpty());
    EXPECT_EQ(world.count(), 2u);
}

TEST(World, CreatesManyFromOneValueOrOneEach)
{
    World world;
    std::vector<Entity> entities(3000);
    std::vector<Velocity> velocities(entities.size());
    for (size_t i = 0; i < velocities.size(); ++i)
        velocities[i].y = static_cast<float>(i);
    world.create(Position{}, Velocity{}); // the bulk starts in the middle of a block
    world.createMany(entities, Position{7, 8, 9}, std::span(velocities), Frozen{});
    for (size_t i = 0; i < entities.size(); ++i) {
        ASSERT_EQ(world.get<const Position>(entities[i]), (Position{7, 8, 9}));
        ASSERT_EQ(world.value<Velocity>(entities[i]), velocities[i]);
        ASSERT_TRUE(world.has<Frozen>(entities[i]));
    }
}

// In one column, in lanes, without values, and beside values of other kinds; over many blocks.
TEST(World, CreatesManyFromFunctions)
{
    World world;
    std::vector<Entity> entities(40'000);
    const auto velocityOf = [](uint32_t i) {
        const auto f = static_cast<float>(i);
        return Velocity{f, -f, 0.5f * f};
    };
    world.createMany(
        entities,
        [](uint32_t i) {
            return Wide{{1.0 * i, 2.0 * i}};
        },
        velocityOf, [](uint32_t) { return Frozen{}; }, Health{3});
    std::vector<Entity> half;
    for (uint32_t i = 0; i < entities.size(); i += 2)
        half.push_back(entities[i]);
    world.addMany(half, [](uint32_t i) { return Position{static_cast<float>(i), 0, 0}; });
    for (uint32_t i = 0; i < entities.size(); ++i) {
        ASSERT_EQ(world.value<Velocity>(entities[i]), velocityOf(i));
        ASSERT_EQ(world.get<const Wide>(entities[i]).values[1], 2.0 * i);
        ASSERT_EQ(world.get<const Health>(entities[i]).points, 3u);
        ASSERT_TRUE(world.has<Frozen>(entities[i]));
        ASSERT_EQ(world.has<Position>(entities[i]), i % 2 == 0);
        if (i % 2 == 0) {
            const auto place = static_cast<uint32_t>(world.get<const Position>(entities[i]).x);
            ASSERT_EQ(place, i / 2);
        }
    }
}

TEST(World, AddAndRemoveKeepTheOtherValues)
{
    World world;
    const Entity a = world.create(Position{1, 1, 1}, Health{5});
    const Entity b = world.create(Position{2, 2, 2}, Health{6});
    world.add(a, Velocity{3, 4, 5}, Frozen{});
    EXPECT_EQ(world.value<Velocity>(a), (Velocity{3, 4, 5}));
    EXPECT_EQ(world.get<const Health>(a).points, 5u);
    EXPECT_EQ(world.get<const Health>(b).points, 6u); // took a's row
    world.add(a, Health{50});                         // overwrites
    EXPECT_EQ(world.get<const Health>(a).points, 50u);
    world.remove<Velocity, Frozen, Wide>(a); // Wide is not there
    EXPECT_FALSE(world.has<Velocity>(a));
    EXPECT_FALSE(world.has<Frozen>(a));
    EXPECT_EQ(world.get<const Position>(a), (Position{1, 1, 1}));
    EXPECT_EXIT(world.set(b, Velocity{}), testing::ExitedWithCode(3), "has no test.Velocity");
}

// Values may come from the world itself, whose blocks grow and whose rows move meanwhile.
TEST(World, CopiesItsOwnValues)
{
    World world;
    const Entity first = world.create(Position{1, 2, 3}, Health{4});
    std::vector<Entity> all{first};
    for (uint32_t i = 0; i < 10000; ++i)
        all.push_back(
            world.create(world.get<const Position>(first), world.get<const Health>(first)));
    for (const Entity entity : all)
        ASSERT_EQ(world.get<const Position>(entity), (Position{1, 2, 3}));
    const Entity last = all.back();
    world.set(last, Health{9});
    const Entity other = world.create(Velocity{});
    world.add(other, world.get<const Health>(last));
    EXPECT_EQ(world.get<const Health>(other).points, 9u);
}

TEST(World, ReusesIndicesWithNewGenerations)
{
    World world;
    const Entity first = world.create(Health{1});
    world.destroy(first);
    const Entity second = world.create(Health{2});
    EXPECT_EQ(first.index, second.index);
    EXPECT_NE(first, second);
    EXPECT_FALSE(world.alive(first));
    EXPECT_FALSE(world.alive(Entity{}));
    EXPECT_FALSE(world.alive(Entity{1000, 1}));
    EXPECT_EXIT(world.destroy(first), testing::ExitedWithCode(3),
                "entity 0#1 is not alive; index 0 is at generation 2");
    EXPECT_EXIT(static_cast<void>(world.has<Health>(Entity{})), testing::ExitedWithCode(3),
                "null entity");
    EXPECT_EXIT(static_cast<void>(world.get<Position>(second)), testing::ExitedWithCode(3),
                "has no test.Position; it has: test.Health");
}

// Free indices are taken in runs where they follow each other; the ids are those of taking them one
// by one, in whatever order they were given back.
TEST(World, CreatesManyWithTheIdsOfOneByOne)
{
    constexpr uint32_t kCount = 3000;
    for (const int order : {0, 1, 2, 3, 4}) {
        World many, one;
        std::vector<Entity> first(kCount), second(kCount + 500), third(second.size());
        many.createMany(first, Health{1});
        one.createMany(first, Health{1});
        if (order == 1)
            std::reverse(first.begin(), first.end());
        else if (order == 2)
            std::shuffle(first.begin(), first.end(), std::mt19937(5));
        else if (order == 3) // runs of all lengths, up and down
            for (uint32_t i = 0, length = 1; i + length <= kCount; i += length, ++length)
                if (length % 2 == 1)
                    std::reverse(first.begin() + i, first.begin() + i + length);
        if (order == 4)
            first.resize(kCount - 1); // one is left
        for (World* world : {&many, &one})
            for (const Entity entity : first)
                world->destroy(entity);
        for (int round = 0; round < 2; ++round) {
            many.createMany(std::span(second), [](uint32_t i) { return Health{i}; });
            for (Entity& entity : third)
                entity = one.create(Health{2});
            ASSERT_EQ(second, third) << order;
            for (uint32_t i = 0; i < second.size(); ++i)
                ASSERT_EQ(many.get<const Health>(second[i]).points, i);
            many.destroyMany(std::span(second));
            one.destroyMany(std::span(third));
        }
        EXPECT_EQ(many.count(), one.count());
    }
}

TEST(World, DestroysMany)
{
    World world;
    std::vector<Entity> entities(1000);
    world.createMany(entities, Health{1});
    const Entity survivor = world.create(Health{2});
    world.destroyMany(entities);
    EXPECT_EQ(world.count(), 1u);
    EXPECT_EQ(world.get<const Health>(survivor).points, 2u);
}

TEST(World, HoldsSingletons)
{
    World world;
    EXPECT_FALSE(world.hasSingleton<Gravity>());
    const Entity holder = world.setSingleton(Gravity{1.6f});
    EXPECT_EQ(world.singleton<const Gravity>().metresPerSecond2, 1.6f);
    EXPECT_EQ(world.setSingleton(Gravity{3.7f}), holder);
    world.singleton<Gravity>().metresPerSecond2 += 1;
    EXPECT_FLOAT_EQ(world.singleton<const Gravity>().metresPerSecond2, 4.7f);
    world.destroy(holder);
    EXPECT_FALSE(world.hasSingleton<Gravity>());
}

TEST(World, TellsWhatItHolds)
{
    World world;
    const Entity parent = world.create(Position{});
    const Entity entity = world.create(Position{1.5f, 0, 0}, Frozen{}, Parent{parent});
    const std::string text = world.dump(entity);
    EXPECT_NE(text.find("entity 1#1"), std::string::npos) << text;
    EXPECT_NE(text.find("test.Position (12 bytes, version 1): 1.5 0 0"), std::string::npos) << text;
    EXPECT_NE(text.find("test.Frozen (tag)"), std::string::npos) << text;
    EXPECT_NE(text.find("): entity 0#1"), std::string::npos) << text;
    EXPECT_NE(world.dump(parent).find("child 1#1"), std::string::npos);

    const WorldStatistics statistics = world.statistics();
    EXPECT_EQ(statistics.entities, 2u);
    EXPECT_EQ(statistics.valueBytes, 12u + 12u + 8u);
    EXPECT_GE(statistics.blockBytes, statistics.valueBytes);
}

#ifndef NDEBUG
TEST(World, RefusesStructuralChangeWhileIterating)
{
    World world;
    const Entity entity = world.create(Health{1});
    const auto breakIt = [&] {
        world.query<Health>().each([&](Health&) { world.destroy(entity); });
    };
    EXPECT_EXIT(breakIt(), testing::ExitedWithCode(3),
                "structural change of .* during 1 iteration");
}
#endif

} // namespace penumbra::ecs
