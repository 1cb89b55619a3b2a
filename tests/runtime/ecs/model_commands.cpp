// Changes recorded and played.
#include "tests/runtime/ecs/model_driver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace penumbra::ecs {

// A batch of commands in up to three buffers, against the rules in command_buffer.h.
void ModelDriver::deferred()
{
    struct New {
        uint32_t buffer;
        Entity deferred;
        uint32_t health; // unique in the world: finds the real entity
        std::optional<Position> position;
        std::optional<Entity> parent; // living, or dead
    };
    std::array<CommandBuffer, 3> buffers{CommandBuffer(1), CommandBuffer(2), CommandBuffer(3)};
    std::vector<New> created;
    std::set<Entity, decltype(&before)> destroyed(&before);
    std::vector<Entity> firstTouch;
    std::set<Entity, decltype(&before)> cleared(&before);
    std::map<Entity, std::optional<std::optional<Entity>>, decltype(&before)> newParents(&before);
    static uint32_t unique = 1000000; // steps leave room for what change() adds to points

    for (uint32_t b = 0; b < 3; ++b) {
        CommandBuffer& commands = buffers[b];
        for (uint32_t i = below(25); i > 0; --i) {
            if (!dead.empty() && chance(5)) {
                commands.add(dead[below(static_cast<uint32_t>(dead.size()))], Health{1});
                continue;
            }
            const uint32_t kind = below(9);
            if (kind == 0 || pool.empty()) {
                New& entity = created.emplace_back(New{b, {}, unique += 100000, {}, {}});
                entity.deferred = commands.create(Velocity{}, Health{entity.health});
                if (chance(50)) {
                    entity.position = position();
                    commands.add(entity.deferred, *entity.position);
                }
                commands.remove<Velocity>(entity.deferred);
                if (chance(50) && !pool.empty()) {
                    const bool useDead = !dead.empty() && chance(10);
                    entity.parent = useDead ? dead.back() : any();
                    commands.setParent(entity.deferred, *entity.parent);
                }
                continue;
            }
            const Entity entity = any();
            ModelEntity& values = model.at(entity);
            if (std::find(firstTouch.begin(), firstTouch.end(), entity) == firstTouch.end())
                firstTouch.push_back(entity);
            if (kind == 1) {
                commands.destroy(entity);
                destroyed.insert(entity);
            } else if (kind == 2) {
                const Position p = position();
                commands.add(entity, p, Frozen{});
                put(entity, p).frozen = true;
            } else if (kind == 3) {
                commands.remove<Position>(entity);
                values.position.reset();
            } else if (kind == 4) {
                const Health h{below(1000)};
                commands.set(entity, h);
                if (values.health)
                    put(entity, h);
            } else if (kind == 5) {
                values.velocity = velocity();
                commands.add(entity, *values.velocity);
            } else if (kind == 6) {
                commands.remove<Health, Frozen>(entity);
                values.health.reset();
                values.frozen = false;
            } else if (kind == 7) {
                const Entity parent = any();
                commands.setParent(entity, parent);
                newParents[entity] = std::optional(parent);
            } else if (!newParents.contains(entity)) {
                commands.remove<Parent>(entity);
                newParents[entity] = std::optional<Entity>();
                cleared.insert(entity);
            }
        }
    }

    std::vector<CommandBuffer*> all{&buffers[0], &buffers[1], &buffers[2]};
    const PlaybackStatistics statistics = play(world, all);

    uint32_t refused = 0;
    for (const Entity entity : firstTouch) {
        const auto found = newParents.find(entity);
        if (found == newParents.end())
            continue;
        const std::optional<Entity> parent = *found->second;
        if (cleared.contains(entity))
            model.at(entity).parent.reset();
        if (parent && modelWithin(*parent, entity))
            ++refused;
        else
            model.at(entity).parent = parent;
    }
    EXPECT_EQ(statistics.refused, refused);
    std::map<uint32_t, Entity> byHealth;
    world.query<const Health>().each(
        [&](Entity entity, const Health& h) { byHealth[h.points] = entity; });
    for (const New& entity : created) {
        if (entity.parent && !model.contains(*entity.parent))
            continue;                            // orphan
        if (!byHealth.contains(entity.health)) { // went with a destroyed parent, checked below
            ASSERT_TRUE(entity.parent);
            bool doomed = false;
            for (std::optional<Entity> at = entity.parent; at; at = model.at(*at).parent)
                doomed = doomed || destroyed.contains(*at);
            ASSERT_TRUE(doomed);
            continue;
        }
        const Entity real = byHealth[entity.health];
        put(real, Health{entity.health}).parent = entity.parent;
        if (entity.position)
            put(real, *entity.position);
    }
    for (const Entity entity : destroyed)
        if (model.contains(entity))
            modelDestroy(entity);
    refreshPool();
}

} // namespace penumbra::ecs
