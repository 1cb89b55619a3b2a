// WorldAccess: the inside of a World, for the files of this folder that work on components by id:
// reflection, prefabs, scene files, snapshots. Not for programs.
#pragma once

#include "runtime/ecs/world.h"

#include <memory>

namespace penumbra::ecs {

class Prefab;

class WorldAccess {
public:
    explicit WorldAccess(World& world) : m_world(world) {}

    [[nodiscard]] static Place rowOf(const World& world, Entity entity)
    {
        return world.place(entity);
    }
    [[nodiscard]] static uint32_t indexCount(const World& world)
    {
        return world.m_entities.indexCount();
    }
    // Of the living entity, or of the next one.
    [[nodiscard]] static uint32_t generation(const World& world, uint32_t index)
    {
        return world.m_entities.generation(index);
    }
    [[nodiscard]] static std::span<Archetype* const> archetypes(const World& world)
    {
        return world.m_archetypes;
    }
    [[nodiscard]] static const std::vector<Entity>& singletons(const World& world)
    {
        return world.m_singletons;
    }
    // Links as they are; order() may be stale.
    [[nodiscard]] static const Hierarchy& links(const World& world) { return world.m_hierarchy; }
    // `root` and everything below it, parents first.
    static void collect(const World& world, Entity root, std::vector<Entity>& out)
    {
        world.m_hierarchy.collect(root, out);
    }
    void assertStructural() const { m_world.assertStructural(); }
    [[nodiscard]] Stamp stamp() const { return m_world.m_stamp; }
    [[nodiscard]] Archetype& archetypeOf(const ComponentMask& mask)
    {
        return m_world.archetypeOf(mask);
    }
    Place add(Entity entity, const ComponentMask& mask)
    {
        return m_world.addSet(entity, registerComponentSet(mask));
    }
    void remove(Entity entity, const ComponentMask& mask)
    {
        m_world.removeSet(entity, registerComponentSet(mask));
    }
    void attach(Entity child, Entity parent)
    {
        m_world.checkParent(child, parent);
        m_world.attachOrFail(child, parent);
    }
    // Observers hear that an entity got `given` components, some of which were there `before`.
    void tellGiven(Entity entity, const ComponentMask& before, const ComponentMask& given)
    {
        if (m_world.m_observers != nullptr)
            m_world.tellGiven({&entity, 1}, before, given);
    }
    // Observers hear of new entities, in this order, with all they have.
    void tellCreated(std::span<const Entity> entities);
    void setSingleton(ComponentId id, Entity entity)
    {
        if (id >= m_world.m_singletons.size())
            m_world.m_singletons.resize(id + 1);
        m_world.m_singletons[id] = entity;
    }

    // `count` new ids, not yet in any archetype.
    void allocate(std::span<Entity> out)
    {
        m_world.m_entities.reserve(out.size());
        for (Entity& entity : out)
            entity = m_world.m_entities.allocate();
    }
    // Rows for them, values unset; returns the first.
    uint32_t append(Archetype& archetype, std::span<const Entity> entities)
    {
        m_world.makeRoom(archetype, static_cast<uint32_t>(entities.size()));
        const uint32_t row = archetype.append(entities, m_world.m_stamp);
        m_world.setPlaces(archetype, row);
        return row;
    }

    // The parts of a World that a snapshot holds, apart from any world.
    struct Contents {
        struct Record {
            uint32_t generation = 1;
            uint32_t archetype = kNone; // kNone: the index is free, or used up
            uint32_t row = 0;
        };
        std::vector<Record> records; // [entity index]
        std::vector<uint32_t> free;  // next one last
        uint32_t count = 0;          // living
        std::vector<std::unique_ptr<Archetype>> archetypes;
        Hierarchy hierarchy;
        std::vector<Entity> singletons;

        // In the order of Hierarchy::order(): gives the same order again.
        void link(Entity entity, Entity parent) // null: a root
        {
            const uint32_t node = hierarchy.nodeOf(entity);
            hierarchy.link(node, parent.isNull() ? 0 : hierarchy.nodeOf(parent));
            hierarchy.m_stale = true;
        }
    };
    [[nodiscard]] static std::vector<uint32_t> freeIndices(const World& world)
    {
        return world.m_entities.freeIndices();
    }
    [[nodiscard]] static Hierarchy freshHierarchy(const World& world)
    {
        Hierarchy copy = world.m_hierarchy;
        copy.refresh(world.m_entities);
        return copy;
    }
    // Observers stay, and hear nothing.
    void replace(Contents&& contents, uint64_t version);

private:
    World& m_world;
};

// instantiate() that tells no observer.
std::vector<Entity> instantiateUntold(World& world, const Prefab& prefab, uint32_t copies = 1);

} // namespace penumbra::ecs
