// Parents and children. The Parent component says who; Hierarchy keeps the links both ways and the
// depth order, in which a transform system walks the tree as plain arrays:
//
//   const auto order = world.hierarchy().order();         // parents before children
//   for (size_t i = 0; i < order.size(); ++i)
//       worldFromNode[i] = order[i].isRoot() ? local(i) : worldFromNode[order[i].parentSlot] *
//       local(i);
//
// Only World and command playback change it: through setParent, add, set, create, remove, destroy.
// A parent's end is the end of its children; a cycle is refused.
#pragma once

#include "runtime/ecs/component.h"
#include "runtime/ecs/entity_table.h"

#include <cstddef>
#include <vector>

namespace penumbra::ecs {

// Written by: World alone (get<Parent> is const).  Read by: anyone.
struct Parent {
    static constexpr std::string_view kName = "Parent";
    Entity entity; // alive as long as this component is
};
static_assert(sizeof(Parent) == 8 && std::is_trivially_copyable_v<Parent>);
template <>
inline constexpr auto kFields<Parent> = fields(PENUMBRA_FIELD(Parent, entity));

// Whom an operation is for: one entity, or it and everything below it at that moment.
enum class Reach : uint8_t { entity, subtree };

class Hierarchy {
public:
    struct Slot {
        Entity entity;
        uint32_t parentSlot = kNone; // index into order(), smaller than the own
        [[nodiscard]] bool isRoot() const { return parentSlot == kNone; }
    };

    // All entities that have a parent or children; parents before children, level by level, within
    // a level in the order of attachment. Current after World::hierarchy() and in systems.
    [[nodiscard]] std::span<const Slot> order() const { return m_order; }
    // First slot of each level, and order().size() at the end: levels may run one by one, the slots
    // of one level in parallel.
    [[nodiscard]] std::span<const uint32_t> levels() const { return m_levels; }

    // Slots whose entities' rows follow each other in one block of one archetype: what a walk in
    // order can treat as arrays. Current as order() is.
    struct Run {
        Archetype* archetype;
        uint32_t row;  // of the first
        uint32_t slot; // of the first
        uint32_t count;
    };
    // Asserts that no row has moved since.
    [[nodiscard]] std::span<const Run> runs() const;
    // order()'s, alone: a third of the bytes.
    [[nodiscard]] std::span<const uint32_t> parentSlots() const { return m_parentSlots; }

    [[nodiscard]] bool contains(Entity entity) const { return find(entity) != nullptr; }
    [[nodiscard]] Entity parentOf(Entity child) const; // null: none
    [[nodiscard]] std::vector<Entity> childrenOf(Entity parent) const;
    // True if `entity` is `ancestor` or below it.
    [[nodiscard]] bool isWithin(Entity entity, Entity ancestor) const;
    [[nodiscard]] size_t bytes() const;

private:
    friend class World;
    friend class CommandPlayback;
    friend class WorldAccess;

    // False, and nothing changed, if it would close a cycle.
    [[nodiscard]] bool attach(Entity child, Entity parent);
    void detach(Entity child);
    // Appends `root` and everything below it, parents first.
    void collect(Entity root, std::vector<Entity>& out) const;
    void refresh(const EntityTable& table);
    void findRuns(const EntityTable& table);
    // For indices below `count`: attach() does not allocate then.
    void makeRoom(size_t count);

    // Links by node; node of an entity = index + 1. Node 0 is the parent of all roots with
    // children.
    struct Node {
        uint32_t generation = 0;
        uint32_t parent = kNone; // kNone: neither parent nor children
        uint32_t firstChild = 0, lastChild = 0, next = 0, previous = 0; // 0: none
    };
    uint32_t nodeOf(Entity entity);
    [[nodiscard]] const Node* find(Entity entity) const
    {
        const size_t node = size_t{entity.index} + 1;
        const bool known = node < m_nodes.size() && m_nodes[node].parent != kNone &&
                           m_nodes[node].generation == entity.generation;
        return known ? &m_nodes[node] : nullptr;
    }
    [[nodiscard]] Entity entityOf(uint32_t node) const
    {
        return {node - 1, m_nodes[node].generation};
    }
    void link(uint32_t child, uint32_t parent);
    void unlink(uint32_t child);

    std::vector<Node> m_nodes{1};
    std::vector<Slot> m_order;
    std::vector<uint32_t> m_parentSlots; // [order().size()]
    std::vector<uint32_t> m_levels{0};
    std::vector<Run> m_runs;
    const EntityTable* m_table = nullptr; // that refresh() saw
    uint64_t m_runsAt = 0;                // its moves() then
    bool m_stale = false;
};

} // namespace penumbra::ecs
