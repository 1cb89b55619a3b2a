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
                   System system, SystemOrder order)
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
    node->order = std::move(order);
    m_systems.push_back(std::move(node));
    phase->systems.push_back(index);
    connect(*phase);
    m_namesChecked = false;
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
                timing.lastRows = node.lastRows;
            }
            timings.push_back(timing);
        }
    return timings;
}

} // namespace penumbra::ecs
