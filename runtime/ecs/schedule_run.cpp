// Schedule::run(): phases, task graph, versions, and the sync point.
#include "runtime/ecs/running_system.h"
#include "runtime/ecs/schedule_node.h"
#include "runtime/ecs/task_group.h"

#include <chrono>
#include <tbb/task_arena.h>

namespace penumbra::ecs {

// Each system writes under a version of its own, given by its place in the order, not by the clock:
// what counts as changed since its last run is then the same at any number of threads.
void Schedule::runSystem(Node& node, Stamp base)
{
    const Stamp stamp{base.version + 1 + node.place, base.version};
    SystemContext context(m_world, node.commands, node.name, node.access, stamp, node.lastRun);
    const RunningSystem running(node.name);
    const auto start = std::chrono::steady_clock::now();
    node.system(context);
    const std::chrono::duration<float, std::milli> time = std::chrono::steady_clock::now() - start;
    if (node.times.size() < kTimingFrames)
        node.times.push_back(time.count());
    else
        node.times[node.runs % kTimingFrames] = time.count();
    ++node.runs;
    node.lastRun = stamp.version;
    node.lastRows = context.rows();
}

void Schedule::runPhase(const Phase& phase, Stamp base)
{
    double lastMs = 0;
    for (const uint32_t index : phase.systems) {
        const Node& node = *m_systems[index];
        lastMs += node.runs > 0 ? node.times[(node.runs - 1) % kTimingFrames] : kInlineMs;
    }
    if (phase.systems.size() < 2 || lastMs < kInlineMs ||
        tbb::this_task_arena::max_concurrency() == 1) {
        for (const uint32_t index : phase.systems)
            runSystem(*m_systems[index], base);
        return;
    }

    TaskGroup* group = nullptr;
    auto runThenNext = [&](uint32_t index) {
        Node& node = *m_systems[index];
        runSystem(node, base);
        for (const uint32_t next : node.next)
            if (m_systems[next]->waiting.fetch_sub(1, std::memory_order_acq_rel) == 1)
                group->start(next);
    };
    TaskGroup tasks(static_cast<uint32_t>(m_systems.size()), runThenNext);
    group = &tasks;
    for (const uint32_t index : phase.systems)
        m_systems[index]->waiting = static_cast<uint32_t>(m_systems[index]->previous.size());
    for (const uint32_t index : phase.systems)
        if (m_systems[index]->previous.empty())
            tasks.start(index);
    tasks.wait();
}

PlaybackStatistics Schedule::run()
{
    m_world.assertStructural();
    if (!m_namesChecked)
        checkNames();
    m_namesChecked = true;
    static_cast<void>(m_world.hierarchy()); // systems see it const: bring it up to date
    const Stamp base = m_world.m_stamp;
    m_world.m_inSystems = true;
    for (const Phase& phase : m_phases)
        runPhase(phase, base);
    m_world.m_inSystems = false;

    // The sync point, under a version after every system's.
    m_world.m_stamp = {base.version + m_systems.size() + 1, base.version};
    std::vector<CommandBuffer*> buffers;
    for (const Phase& phase : m_phases)
        for (const uint32_t index : phase.systems)
            buffers.push_back(&m_systems[index]->commands);
    return play(m_world, buffers);
}

} // namespace penumbra::ecs
