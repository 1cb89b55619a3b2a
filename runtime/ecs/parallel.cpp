// Not instrumented in builds for ThreadSanitizer: thread_order.h.
#include "runtime/ecs/parallel.h"

#include "runtime/ecs/thread_order.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace penumbra::ecs {

void parallelFor(uint32_t count, void* data, void (*call)(void* data, uint32_t index))
{
    if (count < 2 || tbb::this_task_arena::max_concurrency() == 1) {
        for (uint32_t i = 0; i < count; ++i)
            call(data, i);
        return;
    }
    ThreadOrder begin, end;
    begin.release();
    tbb::parallel_for(uint32_t{0}, count, [=, &begin, &end](uint32_t i) {
        begin.acquire();
        call(data, i);
        end.release();
    });
    end.acquire();
}

} // namespace penumbra::ecs
