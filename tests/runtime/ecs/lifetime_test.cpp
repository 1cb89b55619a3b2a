// Components that are not trivially copyable: each value is constructed and destroyed exactly once,
// wherever its row goes; a copy that throws leaves the world as it was.
#include "runtime/ecs/command_buffer.h"
#include "tests/runtime/ecs/components.h"

#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <stdexcept>
#include <string>

namespace penumbra::ecs {

namespace {

// Knows all its living values by address, so that a byte copy, a second destructor or a forgotten
// one shows. copiesLeft: copies until one throws.
struct Tracked {
    static constexpr std::string_view kName = "test.Tracked";
    static inline std::set<const void*> living;
    static inline int64_t copiesLeft = INT64_MAX;
    std::string text = "default, and too long for the string's own room";

    Tracked() { enter(); }
    explicit Tracked(uint32_t value) : text(textOf(value)) { enter(); }
    Tracked(const Tracked& other) : text(other.text)
    {
        if (copiesLeft-- <= 0)
            throw std::runtime_error("copy");
        enter();
    }
    Tracked(Tracked&& other) noexcept : text(std::move(other.text))
    {
        EXPECT_TRUE(living.contains(&other));
        enter();
    }
    Tracked& operator=(const Tracked&) = delete;
    ~Tracked() { EXPECT_EQ(living.erase(this), 1u); }
    void enter() { EXPECT_TRUE(living.insert(this).second); }

    static std::string textOf(uint32_t value)
    {
        return "a text that lies on the heap, number " + std::to_string(value);
    }
};

struct Owner { // cannot be copied
    static constexpr std::string_view kName = "test.Owner";
    std::unique_ptr<uint32_t> value;
};

struct Lifetime : testing::Test {
    void SetUp() override { Tracked::copiesLeft = INT64_MAX; }
    void TearDown() override { EXPECT_TRUE(Tracked::living.empty()); }

    // Values in the world, and nothing else, are alive; each entity has its own text.
    static void expectTexts(World& world, std::span<const Entity> entities, uint32_t first = 0)
    {
        EXPECT_EQ(Tracked::living.size(), world.query<const Tracked>().count());
        for (const Entity entity : entities)
            EXPECT_EQ(world.get<const Tracked>(entity).text, Tracked::textOf(first++));
    }
};

} // namespace

TEST_F(Lifetime, FollowsRowsThroughGrowthRemovalAndTheWorldsEnd)
{
    World world;
    std::vector<Entity> entities;
    for (uint32_t i = 0; i < 40000; ++i) // through all block sizes
        entities.push_back(world.create(Tracked(i), Position{}));
    expectTexts(world, entities);
    for (uint32_t i = 0; i < 5000; ++i) { // the last row takes the gap
        world.destroy(entities[i]);
    }
    entities.erase(entities.begin(), entities.begin() + 5000);
    expectTexts(world, entities, 5000);
    for (const Entity entity : entities)
        world.add(entity, Velocity{}, Health{1}); // another archetype
    expectTexts(world, entities, 5000);
    for (uint32_t i = 0; i < 1000; ++i)
        world.remove<Tracked>(entities[i]);
    entities.erase(entities.begin(), entities.begin() + 1000);
    expectTexts(world, entities, 6000);
    world.destroyMany(std::span(entities).first(3000));
    entities.erase(entities.begin(), entities.begin() + 3000);
    world.trim();
    expectTexts(world, entities, 9000);
}

TEST_F(Lifetime, ValuesAreSetAddedAndOverwritten)
{
    World world;
    const Tracked one(1);
    const Entity a = world.create(one); // copied; the others are moved
    const Entity b = world.create(Health{3});
    world.add(b, Tracked(2), Position{1, 2, 3});
    world.add(a, Tracked(5));
    world.set(a, Tracked(6));
    EXPECT_EQ(world.get<const Tracked>(a).text, Tracked::textOf(6));
    EXPECT_EQ(world.value<Tracked>(b).text, Tracked::textOf(2));
    world.get<Tracked>(b).text = "mine";
    world.remove<Position>(b);
    EXPECT_EQ(world.get<const Tracked>(b).text, "mine");
    world.query<Tracked>().each([](Tracked& tracked) { tracked.text += "!"; });
    EXPECT_EQ(world.get<const Tracked>(b).text, "mine!");
    EXPECT_EQ(Tracked::living.size(), 3u);
    EXPECT_NE(world.dump(b).find("test.Tracked"), std::string::npos);
}

TEST_F(Lifetime, HoldsWhatCannotBeCopied)
{
    World world;
    std::vector<Entity> entities;
    for (uint32_t i = 0; i < 3000; ++i)
        entities.push_back(world.create(Owner{std::make_unique<uint32_t>(i)}));
    CommandBuffer commands;
    commands.add(entities[1], Owner{std::make_unique<uint32_t>(71)});
    commands.add(entities[2], Frozen{});
    play(world, commands);
    world.destroy(entities[0]);
    EXPECT_EQ(*world.get<const Owner>(entities[1]).value, 71u);
    EXPECT_EQ(*world.get<const Owner>(entities[2]).value, 2u);
    EXPECT_EQ(*world.get<const Owner>(entities[2999]).value, 2999u);
}

TEST_F(Lifetime, GoesDownWithTheParent)
{
    World world;
    const Entity root = world.create(Tracked(0));
    const Entity child = world.create(Tracked(1), Parent{root});
    static_cast<void>(world.create(Tracked(2), Parent{child}));
    const Entity other = world.create(Tracked(3));
    world.destroy(root);
    expectTexts(world, {&other, 1}, 3);
}

TEST_F(Lifetime, ManyAtOnce)
{
    World world;
    std::vector<Tracked> values;
    for (uint32_t i = 0; i < 3000; ++i)
        values.emplace_back(i);
    std::vector<Entity> entities(values.size()), same(2000);
    world.createMany(entities, std::span<const Tracked>(values), Position{});
    world.createMany(same, Tracked(9), Health{1});
    EXPECT_EQ(world.get<const Tracked>(same[1999]).text, Tracked::textOf(9));
    world.destroyMany(same);
    values.clear();
    expectTexts(world, entities);
    world.addMany(entities, Health{4});
    world.removeMany<Position>(entities);
    expectTexts(world, entities);
    world.addMany(std::span(entities).first(10), Tracked(8)); // over the old ones
    EXPECT_EQ(world.get<const Tracked>(entities[9]).text, Tracked::textOf(8));
    world.removeMany<Tracked>(entities);
    EXPECT_TRUE(Tracked::living.empty());
    world.addMany(entities, Tracked(7));
    EXPECT_EQ(Tracked::living.size(), entities.size());
}

TEST_F(Lifetime, CommandsCarryValues)
{
    World world;
    const Entity a = world.create(Tracked(0));
    const Entity b = world.create(Health{1});
    const Entity gone = world.create();
    world.destroy(gone);
    {
        CommandBuffer commands, never;
        const Entity made = commands.create(Tracked(10), Health{10});
        commands.add(made, Tracked(11)); // over the first
        commands.set(a, Tracked(1));
        commands.add(b, Tracked(2));
        commands.remove<Tracked>(b);
        commands.add(b, Tracked(3));
        commands.add(gone, Tracked(4));
        const Entity short_ = commands.create(Tracked(5));
        commands.destroy(short_);
        const Entity without = commands.create(Tracked(6), Frozen{});
        commands.remove<Tracked>(without);
        never.add(a, Tracked(7));
        CommandBuffer moved(std::move(commands));
        play(world, moved);
    }
    EXPECT_EQ(Tracked::living.size(), 3u); // a, b, made
    EXPECT_EQ(world.get<const Tracked>(a).text, Tracked::textOf(1));
    EXPECT_EQ(world.get<const Tracked>(b).text, Tracked::textOf(3));
    uint32_t found = 0;
    world.query<const Tracked, const Health>().each([&](const Tracked& t, const Health& h) {
        if (h.points == 10) {
            ++found;
            EXPECT_EQ(t.text, Tracked::textOf(11));
        }
    });
    EXPECT_EQ(found, 1u);
}

TEST_F(Lifetime, ACopyThatThrowsChangesNothing)
{
    World world;
    std::vector<Tracked> values;
    for (uint32_t i = 0; i < 500; ++i)
        values.emplace_back(i);
    std::vector<Entity> entities(values.size());
    world.createMany(entities, std::span<const Tracked>(values), Position{1, 2, 3});
    const Entity bare = world.create(Health{5});
    const Tracked value(77);
    const auto expectSame = [&] {
        EXPECT_EQ(world.count(), 501u);
        EXPECT_EQ(world.query<const Tracked>().count(), 500u);
        EXPECT_EQ(Tracked::living.size(), 500u + values.size() + 1);
        for (uint32_t i = 0; i < entities.size(); ++i)
            EXPECT_EQ(world.get<const Tracked>(entities[i]).text, Tracked::textOf(i));
        EXPECT_EQ(world.get<const Health>(bare).points, 5u);
        EXPECT_FALSE(world.has<Tracked>(bare));
        Tracked::copiesLeft = INT64_MAX;
    };
    const auto failing = [&](int64_t copies, auto change) {
        Tracked::copiesLeft = copies;
        EXPECT_THROW(change(), std::runtime_error);
        expectSame();
    };
    std::vector<Entity> more(500);
    failing(0, [&] { static_cast<void>(world.create(value, Position{})); });
    failing(0, [&] { world.add(bare, value); });
    failing(0, [&] { world.add(entities[3], value); });
    failing(0, [&] { world.set(entities[3], value); });
    failing(0, [&] { world.addMany({&bare, 1}, value); });
    for (const int64_t copies : {0, 1, 250, 499}) {
        failing(copies,
                [&] { world.createMany(more, std::span<const Tracked>(values), Position{}); });
        failing(copies, [&] { world.createMany(more, Health{}, value); });
        failing(copies,
                [&] { world.createMany(more, Position{}, [&](uint32_t i) { return values[i]; }); });
        failing(0, [&] {
            world.addMany({&bare, 1},
                          [&](uint32_t) -> Velocity { throw std::runtime_error("no value"); });
        });
    }
}

} // namespace penumbra::ecs
