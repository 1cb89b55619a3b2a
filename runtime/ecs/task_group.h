// TaskGroup: tasks 0 … count - 1 on the threads of the current TBB arena, which start each other.
//
//   TaskGroup* group = nullptr;
//   auto run = [&](uint32_t index) { …; group->start(next); };
//   TaskGroup tasks(count, run); // `run` outlives it
//   group = &tasks;
//   tasks.start(first);
//   tasks.wait(); // until none is left; passes on what a task throws
#pragma once

#include <cstdint>

namespace penumbra::ecs {

class TaskGroup {
public:
    TaskGroup(uint32_t count, void* data, void (*call)(void* data, uint32_t index));
    template <class F>
    TaskGroup(uint32_t count, F& f)
        : TaskGroup(count, &f, [](void* data, uint32_t index) { (*static_cast<F*>(data))(index); })
    {}
    ~TaskGroup();
    TaskGroup(const TaskGroup&) = delete;
    TaskGroup& operator=(const TaskGroup&) = delete;

    // By whoever made the group, or inside a task; each index once.
    void start(uint32_t index);
    void wait();

private:
    struct State; // needs TBB
    State* m_state;
};

} // namespace penumbra::ecs
