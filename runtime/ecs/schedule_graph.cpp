// Schedule: who waits for whom in a phase, and the picture of it.
#include "runtime/ecs/schedule_node.h"

#include "runtime/assert.h"

#include <algorithm>
#include <fmt/format.h>

namespace penumbra::ecs {

namespace {

bool contains(const std::vector<std::string>& names, const std::string& name)
{
    return std::find(names.begin(), names.end(), name) != names.end();
}

std::string quoted(std::string_view text)
{
    std::string out = "\"";
    for (const char c : text)
        out += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
    return out + '"';
}

} // namespace

bool Schedule::isOrdered(uint32_t first, uint32_t second) const
{
    const Node& a = *m_systems[first];
    const Node& b = *m_systems[second];
    return contains(a.order.before, b.name) || contains(b.order.after, a.name);
}

// Leaves phase.systems in the order of one thread: as added, but for what before and after say.
void Schedule::sortPhase(Phase& phase) const
{
    std::vector<uint32_t> left = phase.systems;
    std::sort(left.begin(), left.end());
    phase.systems.clear();
    const auto blocker = [&](uint32_t system) {
        return std::find_if(left.begin(), left.end(),
                            [&](uint32_t other) { return isOrdered(other, system); });
    };
    while (!left.empty()) {
        const auto ready = std::find_if(left.begin(), left.end(), [&](uint32_t system) {
            return blocker(system) == left.end();
        });
        if (ready == left.end()) { // each waits for one of the others: go back along the waits
            std::vector<uint32_t> path{left.front()};
            while (std::count(path.begin(), path.end(), path.back()) < 2)
                path.push_back(*blocker(path.back()));
            std::string text;
            for (auto at = path.rbegin(); at != path.rend(); ++at) {
                text += fmt::format("{}'{}'", text.empty() ? "" : " before ", m_systems[*at]->name);
                if (at != path.rbegin() && *at == path.back())
                    break;
            }
            PENUMBRA_ASSERT(false, "phase '{}': before and after make a circle: {}", phase.name,
                            text);
        }
        phase.systems.push_back(*ready);
        left.erase(ready);
    }
}

void Schedule::connect(Phase& phase)
{
    sortPhase(phase);
    for (const uint32_t index : phase.systems) {
        m_systems[index]->next.clear();
        m_systems[index]->previous.clear();
    }
    for (size_t second = 0; second < phase.systems.size(); ++second)
        for (size_t first = 0; first < second; ++first) {
            const uint32_t a = phase.systems[first];
            const uint32_t b = phase.systems[second];
            if (!isOrdered(a, b) && !m_systems[a]->access.conflictsWith(m_systems[b]->access))
                continue;
            m_systems[a]->next.push_back(b);
            m_systems[b]->previous.push_back(a);
        }
    uint32_t place = 0;
    for (const Phase& p : m_phases)
        for (const uint32_t i : p.systems)
            m_systems[i]->place = place++;
}

void Schedule::checkNames() const
{
    for (const Phase& phase : m_phases)
        for (const uint32_t index : phase.systems)
            for (const auto* names :
                 {&m_systems[index]->order.before, &m_systems[index]->order.after})
                for (const std::string& name : *names) {
                    const bool known =
                        std::any_of(phase.systems.begin(), phase.systems.end(),
                                    [&](uint32_t other) { return m_systems[other]->name == name; });
                    PENUMBRA_ASSERT(known,
                                    "system '{}' is to run {} '{}', but phase '{}' has no such "
                                    "system; phases order the rest",
                                    m_systems[index]->name,
                                    names == &m_systems[index]->order.before ? "before" : "after",
                                    name, phase.name);
                }
}

std::string Schedule::toDot() const
{
    std::string dot = "digraph schedule {\n    rankdir=LR; node [shape=box];\n";
    for (size_t p = 0; p < m_phases.size(); ++p) {
        dot += fmt::format("    subgraph cluster_{} {{\n        label={};\n", p,
                           quoted(m_phases[p].name));
        for (const uint32_t index : m_phases[p].systems) {
            const Access& access = m_systems[index]->access;
            dot += fmt::format("        {} [tooltip={}];\n", quoted(m_systems[index]->name),
                               quoted(fmt::format("reads {}; writes {}", toString(access.reads),
                                                  toString(access.writes))));
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
            const ComponentMask cause = all - (all - shared);
            dot +=
                fmt::format("    {} -> {} [label={}{}];\n", quoted(before.name), quoted(node->name),
                            quoted(cause.isEmpty() ? "order" : toString(cause)),
                            cause.isEmpty() ? ", style=dashed" : "");
        }
    return dot + "}\n";
}

} // namespace penumbra::ecs
