// Changes made at once.
#include "tests/runtime/ecs/model_driver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace penumbra::ecs {

void ModelDriver::create()
{
    const Position p = position();
    const Velocity v = velocity();
    const Health h{below(1000)};
    switch (below(5)) {
    case 0:
        model[pool.emplace_back(world.create())];
        break;
    case 1:
        put(pool.emplace_back(world.create(p, v)), p).velocity = v;
        break;
    case 2:
        put(pool.emplace_back(world.create(h, Frozen{})), h).frozen = true;
        break;
    case 3: {
        const Entity entity = pool.emplace_back(world.create(v, p, h));
        put(entity, p).velocity = v;
        put(entity, h);
        break;
    }
    default:
        if (!pool.empty()) {
            const Entity parent = any();
            put(pool.emplace_back(world.create(Parent{parent}, p)), p).parent = parent;
        }
    }
}

void ModelDriver::createMany()
{
    std::vector<Entity> created(below(200));
    std::vector<Position> positions(created.size());
    for (Position& p : positions)
        p = position();
    const Health h{below(1000)};
    world.createMany(created, std::span(positions), h);
    for (size_t i = 0; i < created.size(); ++i) {
        put(created[i], positions[i]);
        put(created[i], h);
        pool.push_back(created[i]);
    }
}

void ModelDriver::destroy()
{
    if (chance(80)) {
        const Entity entity = any();
        world.destroy(entity);
        modelDestroy(entity);
    } else {
        std::set<Entity, decltype(&before)> doomed(&before);
        for (uint32_t i = 0; i < below(30); ++i)
            doomed.insert(any());
        world.destroyMany(std::vector(doomed.begin(), doomed.end()));
        for (const Entity entity : doomed)
            if (model.contains(entity))
                modelDestroy(entity);
    }
    refreshPool();
}

// Distinct entities, in runs of one archetype or not.
void ModelDriver::changeMany()
{
    std::vector<Entity> some = pool;
    if (chance(50))
        std::shuffle(some.begin(), some.end(), random);
    some.resize(std::min<size_t>(some.size(), below(60)));
    if (chance(30) && !some.empty()) { // one archetype: like a system's result
        const ComponentMask mask = world.components(some[0]);
        std::erase_if(some, [&](Entity entity) { return !(world.components(entity) == mask); });
    }
    if (chance(50)) {
        std::vector<Position> positions(some.size());
        for (Position& p : positions)
            p = position();
        const Health h{below(1000)};
        world.addMany(some, std::span<const Position>(positions), h, Frozen{});
        for (size_t i = 0; i < some.size(); ++i) {
            put(some[i], positions[i]).frozen = true;
            put(some[i], h);
        }
    } else {
        world.removeMany<Position, Frozen>(some);
        for (const Entity entity : some) {
            model.at(entity).position.reset();
            model.at(entity).frozen = false;
        }
    }
}

// Each row of the hierarchy that has a Position gets its depth along parents with one.
void ModelDriver::walkDown()
{
    world.query<Position>().eachDown(
        world.hierarchy(), [&](Entity entity, Position& p, const Position* parent) {
            p.z = parent != nullptr ? parent->z + 1 : 0;
            const std::optional<Entity> above = model.at(entity).parent;
            const bool has = above && model.at(*above).position;
            ASSERT_EQ(parent != nullptr, has);
            if (has) {
                ASSERT_EQ(*parent, *model.at(*above).position); // the model's is done already
            }
            put(entity, p);
        });
}

void ModelDriver::change(Entity entity)
{
    ModelEntity& values = model.at(entity);
    switch (below(12)) {
    case 0: {
        const Position p = position();
        world.add(entity, p);
        put(entity, p);
        break;
    }
    case 1:
        world.remove<Position>(entity);
        values.position.reset();
        break;
    case 2: {
        const Health h{below(1000)};
        values.velocity = velocity();
        values.frozen = true;
        world.add(entity, h, *values.velocity, Frozen{});
        put(entity, h);
        break;
    }
    case 3:
        world.remove<Health, Frozen>(entity);
        values.health.reset();
        values.frozen = false;
        break;
    case 4:
        world.remove<Velocity>(entity);
        values.velocity.reset();
        break;
    case 5:
    case 6:
        if (Health* h = world.tryGet<Health>(entity)) {
            h->points += 1;
            put(entity, Health{values.health->points + 1});
        } else {
            EXPECT_FALSE(values.health);
        }
        break;
    case 7:
        if (values.position) {
            const Position p = position();
            world.set(entity, p);
            put(entity, p);
        }
        break;
    case 8:
        if (values.velocity) {
            values.velocity->y = number();
            world.set(entity, *values.velocity);
        }
        break;
    case 9:
        world.clearParent(entity);
        values.parent.reset();
        break;
    default: {
        const Entity parent = any();
        const bool allowed = !modelWithin(parent, entity);
        ASSERT_EQ(world.setParent(entity, parent), allowed);
        if (allowed)
            values.parent = parent;
    }
    }
}

} // namespace penumbra::ecs
