// Tells ThreadSanitizer what it cannot see because TBB is not instrumented: what is done before
// work is handed to other threads happens before that work, and the work before what follows the
// wait for it. Nothing in other builds.
#pragma once

#ifdef __SANITIZE_THREAD__
extern "C" {
void __tsan_acquire(void* address);
void __tsan_release(void* address);
}
#endif

namespace penumbra::ecs {

class ThreadOrder {
public:
#ifdef __SANITIZE_THREAD__
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
