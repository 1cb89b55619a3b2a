// A World and a plain model of it (std::map), changed alike by one generator with a fixed seed: a
// failure repeats.
#pragma once

#include "runtime/ecs/command_buffer.h"
#include "tests/runtime/ecs/components.h"

#include <map>
#include <optional>
#include <random>

namespace penumbra::ecs {

struct ModelEntity {
    std::optional<Position> position;
    std::optional<Velocity> velocity;
    std::optional<Health> health;
    bool frozen = false;
    std::optional<Entity> parent;
    uint64_t positionWritten = 0, healthWritten = 0; // version of the last write
};

inline bool before(Entity a, Entity b)
{
    return std::pair(a.index, a.generation) < std::pair(b.index, b.generation);
}

using Model = std::map<Entity, ModelEntity, decltype(&before)>;

struct ModelDriver {
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

} // namespace penumbra::ecs
