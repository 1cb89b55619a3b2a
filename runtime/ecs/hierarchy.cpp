#include "runtime/ecs/hierarchy.h"

#include "runtime/assert.h"
#include "runtime/ecs/archetype.h"

#include <algorithm>

namespace penumbra::ecs {

void Hierarchy::makeRoom(size_t count)
{
    if (m_nodes.size() > count)
        return;
    reserveSparingly(m_nodes, count + 1);
    m_nodes.resize(m_nodes.capacity());
}

uint32_t Hierarchy::nodeOf(Entity entity)
{
    makeRoom(entity.index + size_t{1});
    const uint32_t node = entity.index + 1;
    m_nodes[node].generation = entity.generation;
    return node;
}

void Hierarchy::link(uint32_t child, uint32_t parent)
{
    Node& c = m_nodes[child];
    Node& p = m_nodes[parent];
    c.parent = parent;
    c.previous = p.lastChild;
    c.next = 0;
    (p.lastChild == 0 ? p.firstChild : m_nodes[p.lastChild].next) = child;
    p.lastChild = child;
}

void Hierarchy::unlink(uint32_t child)
{
    Node& c = m_nodes[child];
    Node& p = m_nodes[c.parent];
    (c.previous == 0 ? p.firstChild : m_nodes[c.previous].next) = c.next;
    (c.next == 0 ? p.lastChild : m_nodes[c.next].previous) = c.previous;
    c.parent = kNone;
}

bool Hierarchy::isWithin(Entity entity, Entity ancestor) const
{
    if (entity == ancestor)
        return true;
    const uint32_t goal = ancestor.index + 1;
    for (const Node* node = find(entity); node != nullptr && node->parent != 0;
         node = &m_nodes[node->parent])
        if (node->parent == goal)
            return m_nodes[goal].generation == ancestor.generation;
    return false;
}

bool Hierarchy::attach(Entity child, Entity parent)
{
    if (isWithin(parent, child))
        return false;
    const uint32_t parentNode = nodeOf(parent); // both first: making room moves the nodes
    const uint32_t childNode = nodeOf(child);
    detach(child); // first: it may take the new parent out, if that is the old one too
    if (m_nodes[parentNode].parent == kNone)
        link(parentNode, 0);
    if (m_nodes[childNode].parent == 0)
        unlink(childNode); // a root no longer
    link(childNode, parentNode);
    m_stale = true;
    return true;
}

void Hierarchy::detach(Entity child)
{
    const Node* found = find(child);
    if (found == nullptr || found->parent == 0)
        return;
    const uint32_t node = child.index + 1;
    const uint32_t parent = m_nodes[node].parent;
    unlink(node);
    if (m_nodes[node].firstChild != 0)
        link(node, 0);
    if (m_nodes[parent].firstChild == 0 && m_nodes[parent].parent == 0)
        unlink(parent); // its last child left, and it has no parent: not in the hierarchy any more
    m_stale = true;
}

void Hierarchy::collect(Entity root, std::vector<Entity>& out) const
{
    size_t at = out.size();
    out.push_back(root);
    for (; at < out.size(); ++at)
        if (const Node* node = find(out[at]))
            for (uint32_t child = node->firstChild; child != 0; child = m_nodes[child].next)
                out.push_back(entityOf(child));
}

void Hierarchy::refresh(const EntityTable& table)
{
    if (!m_stale && m_table == &table && m_runsAt == table.moves())
        return;
    if (!m_stale)
        return findRuns(table);
    m_order.clear();
    m_parentSlots.clear();
    m_levels.assign(1, 0);
    const auto pushChildren = [&](uint32_t node, uint32_t slot) {
        for (uint32_t child = m_nodes[node].firstChild; child != 0; child = m_nodes[child].next) {
            m_order.push_back({entityOf(child), slot});
            m_parentSlots.push_back(slot);
        }
    };
    pushChildren(0, kNone);
    for (uint32_t slot = 0; slot < m_order.size();) {
        const auto levelEnd = static_cast<uint32_t>(m_order.size());
        m_levels.push_back(levelEnd);
        for (; slot < levelEnd; ++slot)
            pushChildren(m_order[slot].entity.index + 1, slot);
    }
    findRuns(table);
    m_stale = false;
}

void Hierarchy::findRuns(const EntityTable& table)
{
    m_runs.clear();
    for (uint32_t slot = 0; slot < m_order.size(); ++slot) {
        const Place place = table.place(m_order[slot].entity);
        const uint32_t inBlock = place.row & (place.archetype->blockRows() - 1);
        if (!m_runs.empty() && inBlock != 0) {
            Run& run = m_runs.back();
            if (run.archetype == place.archetype && run.row + run.count == place.row) {
                ++run.count;
                continue;
            }
        }
        m_runs.push_back({place.archetype, place.row, slot, 1});
    }
    m_table = &table;
    m_runsAt = table.moves();
}

std::span<const Hierarchy::Run> Hierarchy::runs() const
{
    PENUMBRA_ASSERT(m_order.empty() || (!m_stale && m_runsAt == m_table->moves()),
                    "rows moved since World::hierarchy() was called");
    return m_runs;
}

Entity Hierarchy::parentOf(Entity child) const
{
    const Node* node = find(child);
    return node == nullptr || node->parent == 0 ? Entity{} : entityOf(node->parent);
}

std::vector<Entity> Hierarchy::childrenOf(Entity parent) const
{
    std::vector<Entity> children;
    if (const Node* node = find(parent))
        for (uint32_t child = node->firstChild; child != 0; child = m_nodes[child].next)
            children.push_back(entityOf(child));
    return children;
}

size_t Hierarchy::bytes() const
{
    return m_nodes.capacity() * sizeof(Node) + m_order.capacity() * sizeof(Slot) +
           (m_parentSlots.capacity() + m_levels.capacity()) * sizeof(uint32_t) +
           m_runs.capacity() * sizeof(Run);
}

} // namespace penumbra::ecs
