// Memory that runs out: every allocation of every structural change fails once. The exception
// passes through, the world is as it was, and the same change works when there is memory again.
// A program of its own, since it replaces operator new.
#include "tests/runtime/ecs/components.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <new>

namespace {

int64_t allocationsLeft = INT64_MAX;

void* allocate(size_t bytes, size_t alignment)
{
    if (allocationsLeft-- <= 0)
        throw std::bad_alloc();
    void* memory = std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
    if (memory == nullptr)
        throw std::bad_alloc();
    return memory;
}

} // namespace

void* operator new(size_t bytes)
{
    return allocate(bytes, alignof(std::max_align_t));
}
void* operator new(size_t bytes, std::align_val_t alignment)
{
    return allocate(bytes, static_cast<size_t>(alignment));
}
void operator delete(void* memory) noexcept
{
    std::free(memory);
}
void operator delete(void* memory, size_t) noexcept
{
    std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept
{
    std::free(memory);
}
void operator delete(void* memory, size_t, std::align_val_t) noexcept
{
    std::free(memory);
}

namespace penumbra::ecs {

namespace {

struct Scene {
    World world;
    std::vector<Entity> entities, loose;
    Entity parent, child;
    explicit Scene(uint32_t n) : entities(n), loose(10)
    {
        world.createMany(entities, Position{1, 2, 3}, Velocity{4, 5, 6});
        world.createMany(loose, Health{7});
        parent = world.create(Health{8});
        child = world.create(Health{9}, Parent{parent});
    }
    void expectSame()
    {
        ASSERT_EQ(world.count(), entities.size() + loose.size() + 2);
        ASSERT_EQ(world.query<const Position>().count(), entities.size());
        for (const Entity entity : entities) {
            ASSERT_EQ(world.get<const Position>(entity), (Position{1, 2, 3}));
            ASSERT_EQ(world.value<Velocity>(entity), (Velocity{4, 5, 6}));
            ASSERT_FALSE(world.has<Health>(entity));
        }
        for (const Entity entity : loose) {
            ASSERT_EQ(world.get<const Health>(entity).points, 7u);
            ASSERT_FALSE(world.has<Parent>(entity));
        }
        ASSERT_EQ(world.get<const Health>(parent).points, 8u);
        ASSERT_EQ(world.hierarchy().parentOf(child), parent);
        ASSERT_EQ(world.hierarchy().order().size(), 2u);
    }
};

} // namespace

TEST(Allocation, EveryFailureLeavesTheWorldAsItWas)
{
    const std::vector<std::pair<const char*, std::function<void(Scene&, std::span<Entity>)>>>
        changes{
            {"create", [](Scene& s, auto) { s.world.create(Position{}, Velocity{}); }},
            {"create, new archetype", [](Scene& s, auto) { s.world.create(Wide{}, Link{}); }},
            {"create below",
             [](Scene& s, auto) { s.world.create(Health{}, Parent{s.entities[0]}); }},
            {"createMany",
             [](Scene& s, std::span<Entity> out) {
                 s.world.createMany(out, Position{}, Health{});
             }},
            {"createMany, more",
             [](Scene& s, std::span<Entity> out) { s.world.createMany(out, Health{}); }},
            {"add", [](Scene& s, auto) { s.world.add(s.entities[1], Health{1}, Frozen{}); }},
            {"add, known archetype",
             [](Scene& s, auto) { s.world.add(s.loose[0], Parent{s.parent}); }},
            {"addMany", [](Scene& s, auto) { s.world.addMany(s.entities, Health{1}); }},
            {"removeMany", [](Scene& s, auto) { s.world.removeMany<Velocity>(s.entities); }},
            {"remove", [](Scene& s, auto) { s.world.remove<Velocity>(s.entities[2]); }},
            {"remove the parent", [](Scene& s, auto) { s.world.clearParent(s.child); }},
            {"setParent",
             [](Scene& s, auto) { static_cast<void>(s.world.setParent(s.loose[1], s.child)); }},
            {"destroy", [](Scene& s, auto) { s.world.destroy(s.parent); }},
            {"destroyMany", [](Scene& s, auto) { s.world.destroyMany(s.entities); }},
        };
    uint32_t allFailures = 0;
    for (const uint32_t n : {16u, 42u, 170u, 682u, 2048u, 16384u}) // around full blocks, and others
        for (const auto& [name, change] : changes) {
            { // components register once
                Scene scene(n);
                std::vector<Entity> out(300);
                change(scene, out);
            }
            bool failed = true;
            uint32_t failures = 0;
            for (; failed; ++failures, ++allFailures) {
                Scene scene(n);
                std::vector<Entity> out(300);
                allocationsLeft = failures;
                try {
                    change(scene, out);
                    failed = false;
                } catch (const std::bad_alloc&) {
                }
                allocationsLeft = INT64_MAX;
                if (!failed)
                    break;
                SCOPED_TRACE(testing::Message()
                             << name << " of " << n << ", allocation " << failures);
                scene.expectSame();
                change(scene, out); // works, and the world with it
                static_cast<void>(scene.world.create(Position{}, Health{}));
                if (HasFailure())
                    return;
            }
        }
    EXPECT_GT(allFailures, 100u);
}

} // namespace penumbra::ecs
