// WorldAccess: the inside of a World, for the files of this folder that work on components by id:
// reflection, prefabs, scene files, snapshots. Not for programs.
#pragma once

#include "runtime/ecs/world.h"

namespace penumbra::ecs {

class WorldAccess {
public:
    explicit WorldAccess(World& world) : m_world(world) {}

    struct Row {
        Archetype* archetype;
        uint32_t row;
    };
    [[nodiscard]] static Row rowOf(const World& world, Entity entity)
    {
        const World::Place at = world.place(entity);
        return {at.archetype, at.row};
    }
    [[nodiscard]] static uint32_t indexCount(const World& world)
    {
        return world.m_entities.indexCount();
    }
    // Of the living entity, or of the next one.
    [[nodiscard]] static uint32_t generation(const World& world, uint32_t index)
    {
        return world.m_entities[Entity{index, 0}].generation;
    }
    [[nodiscard]] static std::span<const std::unique_ptr<Archetype>> archetypes(const World& world)
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
    // Disabled rows, where this world knows such.
    template <class A = Archetype>
    [[nodiscard]] static bool isDisabled(const A& archetype, uint32_t row)
    {
        if constexpr (requires { archetype.disabled().test(row); })
            return archetype.disabled().test(row);
        else
            return false;
    }
    template <class A = Archetype>
    static void disable(A& archetype, uint32_t row, Stamp stamp)
    {
        if constexpr (requires { archetype.setDisabled(row, true, stamp); })
            archetype.setDisabled(row, true, stamp);
    }

    void assertStructural() const { m_world.assertStructural(); }
    [[nodiscard]] Stamp stamp() const { return m_world.m_stamp; }
    [[nodiscard]] Archetype& archetypeOf(const ComponentMask& mask)
    {
        return m_world.archetypeOf(mask);
    }
    Row add(Entity entity, const ComponentMask& mask)
    {
        const World::Place at = m_world.addSet(entity, registerComponentSet(mask));
        return {at.archetype, at.row};
    }
    void remove(Entity entity, const ComponentMask& mask)
    {
        m_world.removeSet(entity, registerComponentSet(mask));
    }
    void attach(Entity child, Entity parent) { m_world.attachOrFail(child, parent); }
    void setSingleton(ComponentId id, Entity entity)
    {
        if (id >= m_world.m_singletons.size())
            m_world.m_singletons.resize(id + 1);
        m_world.m_singletons[id] = entity;
    }

    // `count` new ids, not yet in any archetype.
    void allocate(std::span<Entity> out)
    {
        m_world.m_entities.reserveMore(out.size());
        for (Entity& entity : out)
            entity = m_world.m_entities.allocate();
    }
    // Rows for them, values unset; returns the first.
    uint32_t append(Archetype& archetype, std::span<const Entity> entities)
    {
        uint32_t row = archetype.append(entities, m_world.m_stamp);
        const uint32_t first = row;
        for (const Entity entity : entities) {
            m_world.m_entities[entity].archetype = archetype.index();
            m_world.m_entities[entity].row = row++;
        }
        return first;
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
    [[nodiscard]] static std::span<const uint32_t> freeIndices(const World& world)
    {
        return world.m_entities.m_free;
    }
    [[nodiscard]] static Hierarchy freshHierarchy(const World& world)
    {
        Hierarchy copy = world.m_hierarchy;
        copy.refresh();
        return copy;
    }
    void replace(Contents&& contents, uint64_t version)
    {
        m_world.m_queries.clear();
        m_world.m_bySet.clear();
        m_world.m_byMask.clear();
        EntityTable table;
        for (const Contents::Record& record : contents.records)
            table.m_records.push_back({record.generation, record.archetype, record.row});
        table.m_free = std::move(contents.free);
        table.m_count = contents.count;
        m_world.m_entities = std::move(table);
        m_world.m_archetypes = std::move(contents.archetypes);
        for (const auto& archetype : m_world.m_archetypes)
            m_world.m_byMask.emplace(archetype->mask(), archetype.get());
        m_world.m_hierarchy = std::move(contents.hierarchy);
        m_world.m_singletons = std::move(contents.singletons);
        m_world.m_stamp = {version, version - 1};
        m_world.m_mergeSlots.clear();
    }

private:
    World& m_world;
};

} // namespace penumbra::ecs
