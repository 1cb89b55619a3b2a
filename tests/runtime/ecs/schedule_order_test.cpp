// Explicit order, the graph as text, rows, and where short phases run.
#include "runtime/ecs/schedule.h"
#include "tests/runtime/ecs/components.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <thread>

namespace penumbra::ecs {

namespace {

struct Dot {
    std::map<std::string, std::set<std::string>> phases; // label -> systems
    std::map<std::pair<std::string, std::string>, std::string> edges;
};

std::string unquoted(const std::string& text)
{
    return std::regex_replace(text, std::regex(R"(\\(.))"), "$1");
}

// The part of Graphviz' language that Schedule writes; anything else is an error.
Dot parse(const std::string& text)
{
    const std::string name = R"re("((?:[^"\\]|\\.)*)")re";
    const std::regex head("digraph schedule \\{"), style("    rankdir=LR; node \\[shape=box\\];"),
        cluster("    subgraph cluster_\\d+ \\{"), label("        label=" + name + ";"),
        node("        " + name + " \\[tooltip=" + name + "\\];"), end("    \\}|\\}"),
        edge("    " + name + " -> " + name + " \\[label=" + name + "(, style=dashed)?\\];");
    Dot dot;
    std::set<std::string> systems;
    std::istringstream lines(text);
    std::string phase;
    int depth = 0;
    for (std::string line; std::getline(lines, line);) {
        std::smatch match;
        if (std::regex_match(line, head) || std::regex_match(line, cluster)) {
            ++depth;
        } else if (std::regex_match(line, end)) {
            --depth;
        } else if (std::regex_match(line, match, label)) {
            phase = unquoted(match[1]);
            dot.phases[phase];
        } else if (std::regex_match(line, match, node)) {
            EXPECT_TRUE(systems.insert(unquoted(match[1])).second) << line;
            dot.phases[phase].insert(unquoted(match[1]));
        } else if (std::regex_match(line, match, edge)) {
            EXPECT_TRUE(systems.contains(unquoted(match[1]))) << line;
            EXPECT_TRUE(systems.contains(unquoted(match[2]))) << line;
            dot.edges[{unquoted(match[1]), unquoted(match[2])}] = match[3];
        } else {
            EXPECT_TRUE(std::regex_match(line, style)) << line;
        }
    }
    EXPECT_EQ(depth, 0);
    return dot;
}

} // namespace

TEST(ScheduleOrder, BeforeAndAfterGoBeforeTheOrderOfAdding)
{
    World world;
    Schedule schedule(world, {"only"});
    std::string log;
    const auto note = [&](char c) { return [&log, c](SystemContext&) { log += c; }; };
    schedule.add<Health>("a", "only", note('a'));
    schedule.add<Health>("b", "only", note('b'), {.before = {"a"}, .after = {"d"}});
    schedule.add<Health>("c", "only", note('c'));
    schedule.add<Velocity>("d", "only", note('d'));
    tbb::task_arena(1).execute([&] { schedule.run(); });
    EXPECT_EQ(log, "cdba");
    const auto timings = schedule.timings();
    EXPECT_EQ(timings[0].name, "c");
    EXPECT_EQ(timings[3].name, "a");
    const Dot dot = parse(schedule.toDot());
    EXPECT_EQ(dot.edges.at({"d", "b"}), "order");
    EXPECT_EQ(dot.edges.at({"b", "a"}), "test.Health");
    EXPECT_EQ(dot.edges.at({"c", "a"}), "test.Health");
    EXPECT_FALSE(dot.edges.contains({"a", "b"}));
}

// Commands are played in the order of execution, too.
TEST(ScheduleOrder, CommandsFollowIt)
{
    World world;
    const Entity entity = world.create(Health{});
    Schedule schedule(world, {"only"});
    const auto write = [&](uint32_t points) {
        return [=](SystemContext& c) { c.commands().set(entity, Health{points}); };
    };
    schedule.add<>("second", "only", write(2));
    schedule.add<>("first", "only", write(1), {.before = {"second"}});
    schedule.run();
    EXPECT_EQ(world.get<const Health>(entity).points, 2u);
}

TEST(ScheduleOrder, RefusesCirclesAndUnknownNames)
{
    World world;
    const auto nothing = [](SystemContext&) {};
    const auto circle = [&] {
        Schedule schedule(world, {"one"});
        schedule.add<>("lone", "one", nothing);
        schedule.add<>("a", "one", nothing, {.before = {"b"}});
        schedule.add<>("b", "one", nothing, {.before = {"c"}});
        schedule.add<>("c", "one", nothing, {.before = {"a"}});
    };
    EXPECT_EXIT(circle(), testing::ExitedWithCode(3),
                "phase 'one': before and after make a circle: '([abc])' before '[abc]' before "
                "'[abc]' before '([abc])'");
    const auto unknown = [&] {
        Schedule schedule(world, {"one", "two"});
        schedule.add<>("a", "one", nothing);
        schedule.add<>("b", "two", nothing, {.after = {"a"}});
        schedule.run();
    };
    EXPECT_EXIT(unknown(), testing::ExitedWithCode(3),
                "system 'b' is to run after 'a', but phase 'two' has no such system");
}

TEST(ScheduleOrder, TheGraphIsWhole)
{
    World world;
    Schedule schedule(world, {"simulate", "draw \"it\""});
    const auto nothing = [](SystemContext&) {};
    schedule.add<Position, const Velocity>("move", "simulate", nothing);
    schedule.add<const Position, Velocity>("drag", "simulate", nothing);
    schedule.add<const Velocity>("watch \\ \"v\"", "simulate", nothing);
    schedule.add<const Position>("show", "draw \"it\"", nothing);
    const Dot dot = parse(schedule.toDot());
    EXPECT_EQ(dot.phases.at("simulate"), (std::set<std::string>{"move", "drag", "watch \\ \"v\""}));
    EXPECT_EQ(dot.phases.at("draw \"it\""), std::set<std::string>{"show"});
    EXPECT_EQ(dot.edges.size(), 2u); // readers of one component do not wait for each other
    const std::string both = dot.edges.at({"move", "drag"});
    EXPECT_NE(both.find("test.Position"), std::string::npos);
    EXPECT_NE(both.find("test.Velocity"), std::string::npos);
    EXPECT_EQ(dot.edges.at({"drag", "watch \\ \"v\""}), "test.Velocity");
}

TEST(ScheduleOrder, CountsRows)
{
    World world;
    std::vector<Entity> entities(100);
    world.createMany(entities, Health{});
    world.setEnabled(entities[0], false);
    Schedule schedule(world, {"only"});
    schedule.add<Health>("walk", "only", [](SystemContext& context) {
        context.query<Health>().each([](Health&) {});
        context.query<const Health, WithDisabled>().each([](const Health&) {});
    });
    schedule.run();
    schedule.run();
    EXPECT_EQ(schedule.timings()[0].lastRows, 199u);
}

// Once a phase is known to be short, it stays on the calling thread.
TEST(ScheduleOrder, ShortPhasesRunInline)
{
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, 4);
    tbb::task_arena arena(4);
    arena.execute([] {
        World world;
        Schedule schedule(world, {"only"});
        const std::thread::id self = std::this_thread::get_id();
        uint32_t inlineRuns = 0;
        std::array<bool, 4> here{};
        for (uint32_t i = 0; i < here.size(); ++i)
            schedule.add<>(fmt::format("s{}", i), "only", [&here, i, self](SystemContext&) {
                here[i] = std::this_thread::get_id() == self;
            });
        for (uint32_t frame = 0; frame < 200; ++frame) {
            schedule.run();
            inlineRuns += here[0] && here[1] && here[2] && here[3];
        }
        EXPECT_GT(inlineRuns, 150u); // not all: a busy machine makes some runs long
    });
}

} // namespace penumbra::ecs
