// Private to Schedule: one system with its book-keeping.
#pragma once

#include "runtime/ecs/schedule.h"

#include <atomic>

namespace penumbra::ecs {

struct Schedule::Node {
    std::string name;
    Access access;
    System system;
    SystemOrder order;
    CommandBuffer commands;
    std::vector<uint32_t> next;        // systems of the phase that wait for this one
    std::vector<uint32_t> previous;    // systems of the phase that this one waits for
    std::atomic<uint32_t> waiting = 0; // of `previous`, still to finish in this run
    uint32_t place = 0; // among all systems, phase by phase: its place in a run on one thread
    uint64_t lastRun = 0;
    std::vector<float> times; // ms, ring of kTimingFrames
    uint32_t runs = 0;
    uint64_t lastRows = 0;
};

} // namespace penumbra::ecs
