#include "runtime/ecs/schedule_node.h"

#include "runtime/assert.h"

#include <algorithm>
#include <fmt/format.h>

namespace penumbra::ecs {

Schedule::Schedule(World& world, std::vector<std::string> phases) : m_world(world)
{
    for (std::string& phase : phases)
        m_phases.push_back({std::move(phase), {}});
}

Schedule::~Schedule() = default;

void Schedule::add(std::string name, std::string_view phaseName, const Access& access,
                   System system)
{
    const auto index = static_cast<uint32_t>(m_systems.size());
    const auto phase = std::find_if(m_phases.begin(), m_phases.end(),
                                    [&](const Phase& p) { return p.name == phaseName; });
    PENUMBRA_ASSERT(phase != m_phases.end(), "system '{}': no phase '{}'", name, phaseName);
    for (const auto& other : m_systems)
        PENUMBRA_ASSERT(other->name != name, "two systems are called '{}'", name);

    auto node = std::make_unique<Node>();
    node->name = std::move(name);
    node->access = access;
    node->system = std::move(system);
    node->commands = CommandBuffer(index + 1);
    for (const uint32_t earlier : phase->systems)
        if (m_systems[earlier]->access.conflictsWith(access)) {
            m_systems[earlier]->next.push_back(index);
            node->previous.push_back(earlier);
        }
    m_systems.push_back(std::move(node));
    phase->systems.push_back(index);

    uint32_t order = 0;
    for (const Phase& p : m_phases)
        for (const uint32_t i : p.systems)
            m_systems[i]->order = order++;
}

std::vector<Schedule::Timing> Schedule::timings() const
{
    std::vector<Timing> timings;
    for (const Phase& phase : m_phases)
        for (const uint32_t index : phase.systems) {
            const Node& node = *m_systems[index];
            Timing timing{node.name};
            if (node.runs > 0) {
                std::vector<float> sorted = node.times;
                const auto middle = sorted.begin() + static_cast<ptrdiff_t>(sorted.size() / 2);
                std::nth_element(sorted.begin(), middle, sorted.end());
                timing.medianMs = *middle;
                timing.lastMs = node.times[(node.runs - 1) % kTimingFrames];
            }
            timings.push_back(timing);
        }
    return timings;
}

std::string Schedule::toDot() const
{
    std::string dot = "digraph schedule {\n    rankdir=LR; node [shape=box];\n";
    for (size_t p = 0; p < m_phases.size(); ++p) {
        dot +=
            fmt::format("    subgraph cluster_{} {{\n        label=\"{}\";\n", p, m_phases[p].name);
        for (const uint32_t index : m_phases[p].systems) {
            const Access& access = m_systems[index]->access;
            dot += fmt::format("        \"{}\" [tooltip=\"reads {}; writes {}\"];\n",
                               m_systems[index]->name, toString(access.reads),
                               toString(access.writes));
        }
        dot += "    }\n";
    }
    for (const auto& node : m_systems)
        for (const uint32_t previous : node->previous) {
            const Node& before = *m_systems[previous];
            const ComponentMask all = before.access.writes | node->access.writes;
            const ComponentMask first = before.access.reads | before.access.writes;
            const ComponentMask second = node->access.reads | node->access.writes;
            const ComponentMask shared = first - (first - second);
            dot += fmt::format("    \"{}\" -> \"{}\" [label=\"{}\"];\n", before.name, node->name,
                               toString(all - (all - shared)));
        }
    return dot + "}\n";
}

} // namespace penumbra::ecs
