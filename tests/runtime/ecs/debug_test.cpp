// What people read: messages, dump(), statistics.
#include "runtime/ecs/debug_hooks.h"
#include "runtime/ecs/observers.h"
#include "runtime/ecs/schedule.h"
#include "tests/runtime/ecs/described.h"

#include <gtest/gtest.h>

namespace penumbra::ecs {

namespace {

struct Label { // the name of an entity
    static constexpr std::string_view kName = "test.Label";
    char text[16] = "";
};

struct DebugTest : testing::Test {
    DebugTest()
    {
        debugHooks() = {};
        nameEntitiesBy<Label>([](const Label& label) { return std::string_view(label.text); });
        world.rememberDestroyed(true);
    }
    ~DebugTest() override { debugHooks() = m_before; }

    World world;

private:
    DebugHooks m_before = debugHooks();
};

} // namespace

TEST_F(DebugTest, StaleEntitiesAreRemembered)
{
    const Entity ball = world.create(Label{"ball"}, Health{1});
    const Entity child = world.create(Parent{ball}, Frozen{});
    EXPECT_EQ(world.describe(ball), "0#1 'ball'");
    world.destroy(ball);
    EXPECT_EQ(world.describe(ball), "0#1 'ball'");
    world.create(Label{"other"});
    EXPECT_EXIT(static_cast<void>(world.get<Health>(ball)), testing::ExitedWithCode(3),
                "entity 0#1 'ball' is not alive; index 0 is at generation 2; it was destroyed and "
                "had: .*test.Health.*test.Label|test.Label.*test.Health");
    EXPECT_EXIT(static_cast<void>(world.value<Health>(child)), testing::ExitedWithCode(3),
                "entity 1#1 is not alive.* had: .*test.Frozen");
    std::vector<Entity> many(3000); // in bulk, past the log's size
    world.createMany(many, Label{"crowd"});
    world.destroyMany(many);
    EXPECT_EQ(world.describe(many.back()), toString(many.back()) + " 'crowd'");
    EXPECT_EQ(world.describe(many.front()), toString(many.front()));
    world.rememberDestroyed(false);
    EXPECT_EXIT(world.destroy(child), testing::ExitedWithCode(3), "rememberDestroyed.true.");
}

TEST_F(DebugTest, MessagesNameTheEntity)
{
    const Entity ball = world.create(Label{"ball"});
    const Entity box = world.create(Label{"box"}, Parent{ball});
    EXPECT_EXIT(static_cast<void>(world.get<Health>(ball)), testing::ExitedWithCode(3),
                "entity 0#1 'ball' has no test.Health; it has: test.Label");
    EXPECT_EXIT(world.add(ball, Parent{box}), testing::ExitedWithCode(3),
                "0#1 'ball' under 1#1 'box' closes a cycle");
}

TEST_F(DebugTest, DumpIsComplete)
{
    const Entity root = world.create(Label{"root"});
    const Entity entity =
        world.create(Label{"ball"}, Parent{root}, Frozen{}, Velocity{1, 2.5f, 3}, Link{7, root});
    const Entity child = world.create(Parent{entity});
    world.setEnabled(entity, false);
    std::string text = world.dump(entity);
    for (const char* line :
         {"entity 1#1 'ball', disabled, archetype 2, row 0\n", "  parent 0#1 'root'\n",
          "  test.Frozen (tag)\n", "  test.Velocity (12 bytes, version 1): 1 2.5 3\n",
          "  test.Link (12 bytes, version 1): 7 0#1\n", "  child 2#1\n"})
        EXPECT_NE(text.find(line), std::string::npos) << line << "not in\n" << text;
    EXPECT_NE(world.dump(child).find("  Parent (8 bytes, version 1): 1#1\n"), std::string::npos)
        << world.dump(child);

    debugHooks().value = [](ComponentId id, const void* value) {
        if (id != componentId<Velocity>())
            return std::string();
        return fmt::format("x = {}", static_cast<const Velocity*>(value)->x);
    };
    text = world.dump(entity);
    EXPECT_NE(text.find("test.Velocity (12 bytes, version 1): x = 1\n"), std::string::npos) << text;
    EXPECT_NE(text.find("test.Link (12 bytes, version 1): 7 0#1\n"), std::string::npos) << text;
}

TEST_F(DebugTest, StatisticsAddUp)
{
    std::vector<Entity> entities(2000);
    world.createMany(entities, Position{}, Velocity{});
    world.create(Health{}, Frozen{});
    world.setEnabled(entities[5], false);
    const WorldStatistics all = world.statistics();
    ASSERT_EQ(all.perArchetype.size(), all.archetypes);
    WorldStatistics sum;
    for (const ArchetypeStatistics& one : all.perArchetype) {
        sum.entities += one.rows;
        sum.disabled += one.disabledRows;
        sum.segments += one.segments;
        sum.valueBytes += one.valueBytes;
        sum.blockBytes += one.blockBytes;
        sum.bookBytes += one.bookBytes;
        EXPECT_GE(one.blockBytes, one.valueBytes);
    }
    EXPECT_EQ(sum.entities, all.entities);
    EXPECT_EQ(sum.disabled, 1u);
    EXPECT_EQ(all.disabled, 1u);
    EXPECT_EQ(sum.segments, all.segments);
    EXPECT_EQ(sum.valueBytes, all.valueBytes);
    EXPECT_EQ(all.valueBytes, 2000u * 24 + 4);
    EXPECT_EQ(sum.blockBytes, all.blockBytes);
    EXPECT_LE(sum.bookBytes, all.bookBytes); // the entity table is nobody's own
    const std::string text = toString(all);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2 + all.archetypes) << text;
    EXPECT_NE(text.find("2001 entities (1 disabled), 3 archetypes"), std::string::npos) << text;
    const std::string names = toString(componentSet<Position, Velocity>().mask);
    EXPECT_NE(text.find(names + "\n"), std::string::npos) << text;
}

#ifndef NDEBUG
TEST_F(DebugTest, StructuralChangesTellWhereAndOfWhat)
{
    const Entity ball = world.create(Label{"ball"}, Health{});
    const auto inQuery = [&] {
        world.query<Health>().each([&](Health&) { world.add(ball, Frozen{}); });
    };
    EXPECT_EXIT(inQuery(), testing::ExitedWithCode(3),
                "structural change of 0#1 'ball' during 1 iteration");
    const auto advancing = [&] { world.query<Health>().each([&](Health&) { world.advance(); }); };
    EXPECT_EXIT(advancing(), testing::ExitedWithCode(3), "advance.. during 1 iteration");
    const auto inSystem = [&](auto system) {
        Schedule schedule(world, {"only"});
        schedule.add<const Health>("rogue", "only", system);
        schedule.run();
    };
    EXPECT_EXIT(inSystem([&](SystemContext&) { world.destroy(ball); }), testing::ExitedWithCode(3),
                "structural change of 0#1 'ball' in system 'rogue': use context.commands");
    EXPECT_EXIT(inSystem([&](SystemContext&) { static_cast<void>(world.get<Health>(ball)); }),
                testing::ExitedWithCode(3), "World used inside a system .system 'rogue'.");
    EXPECT_EXIT(inSystem([&](SystemContext& c) { static_cast<void>(c.tryGet<Health>(ball)); }),
                testing::ExitedWithCode(3), "'rogue' writes test.Health without declaring it");
    EXPECT_EXIT(inSystem([&](SystemContext& c) {
                    static_cast<void>(c.query<const Health, Changed<Velocity>>());
                }),
                testing::ExitedWithCode(3), "'rogue' reads test.Velocity without declaring it");
    const Observer watch = onSet<Health>(world, [&](const Observation&) {
        world.setEnabled(ball, false); // tells nobody: the debug assert alone catches it
    });
    EXPECT_EXIT(world.set(ball, Health{}), testing::ExitedWithCode(3),
                "structural change of 0#1 'ball' in an observer");
}
#endif

// Without further ado: Name names, and described components show their fields.
TEST(Debug, NamesAndFieldsAreShownByThemselves)
{
    World world;
    const Entity target = world.create(Name("target"));
    Everything value;
    value.target = target;
    const Entity entity = world.create(Name("all"), value, Position{1, 2, 3});
    EXPECT_EQ(world.describe(entity), "1#1 'all'");
    const std::string text = world.dump(entity);
    EXPECT_NE(
        text.find("power 40 W, exact 0.1, offset -3, count 7, on true, shape square, colour (0 "
                  "0 0), rotation (0 0 0 1), target 0#1, label 'abc', mesh 4294967295\n"),
        std::string::npos)
        << text;
    EXPECT_NE(text.find("test.Position (12 bytes, version 1): 1 2 3\n"), std::string::npos) << text;
}

} // namespace penumbra::ecs
