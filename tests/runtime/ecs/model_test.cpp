// Random operations on a World and on a plain model of it, compared all the way.
#include "tests/runtime/ecs/model_driver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

namespace penumbra::ecs {

// Loops, as systems write them.
void ModelDriver::system()
{
    uint32_t rows = 0;
    world.query<Position, const Velocity, Without<Frozen>>().each(
        [&](Entity entity, Position& p, const Velocity& v) {
            p.x += v.x;
            put(entity, p);
            ++rows;
        });
    uint32_t expected = 0;
    for (const auto& [entity, values] : model)
        expected += values.position && values.velocity && !values.frozen;
    ASSERT_EQ(rows, expected);
    world.query<Velocity, With<Frozen>, Maybe<Health>>().each(
        [&](Entity entity, Velocity& v, Health* h) {
            v.z += 1;
            model.at(entity).velocity->z += 1;
            if (h != nullptr) {
                h->points ^= 1;
                put(entity, *h);
            }
        });
}

void ModelDriver::checkOne(Entity entity, const ModelEntity& values)
{
    ASSERT_TRUE(world.alive(entity));
    ASSERT_EQ(world.has<Position>(entity), values.position.has_value());
    ASSERT_EQ(world.has<Velocity>(entity), values.velocity.has_value());
    ASSERT_EQ(world.has<Health>(entity), values.health.has_value());
    ASSERT_EQ(world.has<Frozen>(entity), values.frozen);
    ASSERT_EQ(world.has<Parent>(entity), values.parent.has_value());
    if (values.position) {
        ASSERT_EQ(world.value<Position>(entity), *values.position);
    }
    if (values.velocity) {
        ASSERT_EQ(world.value<Velocity>(entity), *values.velocity);
    }
    if (values.health) {
        ASSERT_EQ(world.value<Health>(entity), *values.health);
    }
    if (values.parent) {
        ASSERT_EQ(world.value<Parent>(entity).entity, *values.parent);
        ASSERT_EQ(world.hierarchy().parentOf(entity), *values.parent);
    }
}

void ModelDriver::checkAll()
{
    ASSERT_EQ(world.count(), model.size());
    std::map<Entity, uint32_t, decltype(&before)> seen(&before);
    world.query<>().each([&](Entity entity) { ++seen[entity]; });
    ASSERT_EQ(seen.size(), model.size());
    std::set<Entity, decltype(&before)> inTree(&before);
    for (const auto& [entity, values] : model) {
        ASSERT_EQ(seen[entity], 1u);
        checkOne(entity, values);
        if (values.parent) {
            inTree.insert(entity);
            inTree.insert(*values.parent);
        }
    }
    const auto order = world.hierarchy().order();
    ASSERT_EQ(order.size(), inTree.size());
    for (uint32_t i = 0; i < order.size(); ++i) {
        ASSERT_EQ(inTree.erase(order[i].entity), 1u);
        const std::optional<Entity> parent = model.at(order[i].entity).parent;
        ASSERT_EQ(order[i].isRoot(), !parent);
        if (!parent)
            continue;
        ASSERT_LT(order[i].parentSlot, i);
        ASSERT_EQ(order[order[i].parentSlot].entity, *parent);
    }
    for (const Entity entity : dead)
        ASSERT_FALSE(world.alive(entity));
}

// Never a miss, however old the reader.
void ModelDriver::checkChanges(uint64_t since)
{
    std::set<Entity, decltype(&before)> positions(&before);
    std::set<Entity, decltype(&before)> healths(&before);
    world.query<const Position, Changed<Position>>().since(since).each(
        [&](Entity entity, const Position&) { positions.insert(entity); });
    world.query<const Health, Changed<Health>>().since(since).each(
        [&](Entity entity, const Health&) { healths.insert(entity); });
    for (const auto& [entity, values] : model) {
        if (values.position && values.positionWritten > since) {
            ASSERT_TRUE(positions.contains(entity)) << toString(entity);
        }
        if (values.health && values.healthWritten > since) {
            ASSERT_TRUE(healths.contains(entity)) << toString(entity);
        }
    }
}

namespace {

// PENUMBRA_MODEL_OPERATIONS overrides; ten million take minutes.
constexpr uint64_t kOperations = 150000;
constexpr uint32_t kMostEntities = 1500;

} // namespace

TEST(Model, WorldBehavesLikeAMap)
{
    const char* const given = std::getenv("PENUMBRA_MODEL_OPERATIONS");
    const uint64_t operations = given != nullptr ? std::stoull(given) : kOperations;
    const uint64_t checkEvery = std::clamp<uint64_t>(operations / 200, 997, 99991);
    ModelDriver driver;
    for (uint64_t i = 0; i < operations; ++i) {
        const uint32_t kind = driver.below(1000);
        if (driver.pool.empty() || (kind < 250 && driver.pool.size() < kMostEntities))
            driver.create();
        else if (kind < 252 && driver.pool.size() < kMostEntities)
            driver.createMany();
        else if (kind < 270)
            driver.destroy();
        else if (kind < 275)
            driver.deferred();
        else if (kind < 276)
            driver.system();
        else if (kind < 280)
            driver.changeMany();
        else if (kind < 281)
            driver.walkDown();
        else
            driver.change(driver.any());
        if (kind >= 990)
            driver.world.advance();
        if (i % checkEvery == 0) {
            driver.checkAll();
            const uint64_t version = driver.world.version();
            driver.checkChanges(version - std::min<uint64_t>(version, 1 + driver.below(12)));
        }
        if (i % 50000 == 49999)
            driver.world.trim();
        if (testing::Test::HasFatalFailure() || testing::Test::HasNonfatalFailure())
            FAIL() << "operation " << i;
    }
}

} // namespace penumbra::ecs
