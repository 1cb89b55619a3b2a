// Tells ThreadSanitizer what it cannot see because TBB is not instrumented: what is done before
// work is handed to other threads happens before that work, and the work before what follows the
// wait for it. Nothing in other builds. The files that touch TBB's tasks, parallel.cpp and
// task_group.cpp, are not instrumented either in such builds (CMakeLists.txt): its headers would be
// reported all over. What the tasks call lies elsewhere, and is checked.
#pragma once

#ifdef PENUMBRA_TSAN
extern "C" {
void __tsan_acquire(void* address);
void __tsan_release(void* address);
}
#endif

namespace penumbra::ecs {

class ThreadOrder {
public:
#ifdef PENUMBRA_TSAN
    void release()
    {
        __tsan_release(&m_place);
    }
    void acquire()
    {
        __tsan_acquire(&m_place);
    }

private:
    char m_place = 0;
#else
    void release() {}
    void acquire() {}
#endif
};

} // namespace penumbra::ecs
