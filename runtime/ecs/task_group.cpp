// Not instrumented in builds for ThreadSanitizer: thread_order.h.
#include "runtime/ecs/task_group.h"

#include "runtime/ecs/thread_order.h"

#include <tbb/task_group.h>

#include <vector>

namespace penumbra::ecs {

struct TaskGroup::State {
    void* data;
    void (*call)(void* data, uint32_t index);
    std::vector<ThreadOrder> started; // [index]
    ThreadOrder ended;
    tbb::task_group group;
};

TaskGroup::TaskGroup(uint32_t count, void* data, void (*call)(void* data, uint32_t index))
    : m_state(new State{data, call, std::vector<ThreadOrder>(count), {}, {}})
{}

TaskGroup::~TaskGroup()
{
    delete m_state;
}

void TaskGroup::start(uint32_t index)
{
    m_state->started[index].release();
    m_state->group.run([state = m_state, index] {
        state->started[index].acquire();
        state->call(state->data, index);
        state->ended.release();
    });
}

void TaskGroup::wait()
{
    m_state->group.wait();
    m_state->ended.acquire();
}

} // namespace penumbra::ecs
