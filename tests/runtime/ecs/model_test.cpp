// Random operations on a World and on a plain model of it (std::map), compared all the way. Both
// are driven by one generator with a fixed seed: a failure repeats.
#include "runtime/ecs/command_buffer.h"
#include "tests/runtime/ecs/components.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <optional>
#include <random>
#include <set>

namespace penumbra::ecs {

namespace {

// PENUMBRA_MODEL_OPERATIONS overrides; ten million take minutes.
constexpr uint64_t kOperations = 150000;
constexpr uint32_t kMostEntities = 1500;

struct ModelEntity {
    std::optional<Position> position;
    std::optional<Velocity> velocity;
    std::optional<Health> health;
    bool frozen = false;
    std::optional<Entity> parent;
    uint64_t positionWritten = 0, healthWritten = 0; // version of the last write
};

bool before(Entity a, Entity b)
{
    return std::pair(a.index, a.generation) < std::pair(b.index, b.generation);
}

using Model = std::map<Entity, ModelEntity, decltype(&before)>;

struct Driver {
    World world;
    Model model{&before};
    std::mt19937 random{20260122};
    std::vector<Entity> pool; // living, any order
    std::vector<Entity> dead; // some

    uint32_t below(uint32_t n) { return random() % n; }
    bool chance(uint32_t percent) { return below(100) < percent; }
    float number() { return static_cast<float>(below(1000)); }
    Position position() { return {number(), number(), number()}; }
    Velocity velocity() { return {number(), number(), number()}; }
    Entity any() { return pool[below(static_cast<uint32_t>(pool.size()))]; }

    void refreshPool()
    {
        pool.clear();
        for (const auto& [entity, values] : model)
            pool.push_back(entity);
    }

    bool modelWithin(Entity entity, Entity ancestor)
    {
        for (std::optional<Entity> at = entity; at; at = model.at(*at).parent)
            if (*at == ancestor)
                return true;
        return false;
    }

    void modelDestroy(Entity entity)
    {
        std::vector<Entity> children;
        for (const auto& [child, values] : model)
            if (values.parent == entity)
                children.push_back(child);
        for (const Entity child : children)
            modelDestroy(child);
        model.erase(entity);
        dead.push_back(entity);
        if (dead.size() > 100)
            dead.erase(dead.begin(), dead.begin() + 50);
    }

    ModelEntity& put(Entity entity, const Position& value)
    {
        ModelEntity& values = model[entity];
        values.position = value;
        values.positionWritten = world.version();
        return values;
    }
    ModelEntity& put(Entity entity, const Health& value)
    {
        ModelEntity& values = model[entity];
        values.health = value;
        values.healthWritten = world.version();
        return values;
    }

    void create();
    void createMany();
    void destroy();
    void changeMany();
    void walkDown();
    void change(Entity entity);
    void deferred();
    void system();
    void checkOne(Entity entity, const ModelEntity& values);
    void checkAll();
    void checkChanges(uint64_t since);
};

void Driver::create()
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

void Driver::createMany()
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

void Driver::destroy()
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
void Driver::changeMany()
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
void Driver::walkDown()
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

void Driver::change(Entity entity)
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

// A batch of commands in up to three buffers, against the rules in command_buffer.h.
void Driver::deferred()
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

// Loops, as systems write them.
void Driver::system()
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

void Driver::checkOne(Entity entity, const ModelEntity& values)
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

void Driver::checkAll()
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
void Driver::checkChanges(uint64_t since)
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

} // namespace

TEST(Model, WorldBehavesLikeAMap)
{
    const char* const given = std::getenv("PENUMBRA_MODEL_OPERATIONS");
    const uint64_t operations = given != nullptr ? std::stoull(given) : kOperations;
    const uint64_t checkEvery = std::clamp<uint64_t>(operations / 200, 997, 99991);
    Driver driver;
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
