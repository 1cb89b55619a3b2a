// Samples of docs/ecs.md: systems and the schedule. See guide_components.h.
#include "runtime/ecs/schedule.h"
#include "tests/runtime/ecs/guide_components.h"

#include <gtest/gtest.h>

namespace game {

namespace {

// [system]
void move(SystemContext& context)
{
    context.query<Position, const Velocity>().parallelEach([](Position& p, const Velocity& v) {
        p.x += v.x;
        p.y += v.y;
        p.z += v.z;
    });
}

void fall(SystemContext& context)
{
    const float g = context.singleton<const Gravity>().metresPerSecond2;
    context.query<Velocity>().each([&](Velocity& v) { v.y -= g; });
}

void bury(SystemContext& context)
{
    context.query<const Position, Changed<Position>>().each([&](Entity entity, const Position& p) {
        if (p.y < -100)
            context.commands().destroy(entity); // after the last phase
    });
}
// [end]

} // namespace

TEST(Guide, Schedule)
{
    World world;
    const Entity low = world.create(Position{0, -90, 0}, Velocity{});
    // [schedule]
    world.setSingleton(Gravity{});
    Schedule schedule(world, {"simulate", "clean"});
    schedule.add<Position, const Velocity>("move", "simulate", move);
    schedule.add<Velocity, const Gravity>("fall", "simulate", fall, {.before = {"move"}});
    schedule.add<const Position>("bury", "clean", bury);
    for (int frame = 0; frame < 2; ++frame)
        schedule.run();
    EXPECT_FALSE(world.alive(low));
    // [end]
    // [timings]
    for (const Schedule::Timing& timing : schedule.timings())
        fmt::print("{:10} {:.3f} ms, {} rows\n", timing.name, timing.medianMs, timing.lastRows);
    const std::string dot = schedule.toDot(); // dot -Tsvg
    EXPECT_NE(dot.find("\"fall\" -> \"move\" [label=\"game.Velocity\"]"), std::string::npos);
    // [end]
    EXPECT_EQ(schedule.timings()[0].name, "fall");
}

} // namespace game
