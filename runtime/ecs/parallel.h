// parallelFor(count, f): f(0) … f(count - 1) on the threads of the current TBB arena, in no order,
// so f writes only what belongs to its index. On one thread it is a plain loop.
#pragma once

#include <cstdint>
#include <type_traits>

namespace penumbra::ecs {

void parallelFor(uint32_t count, void* data, void (*call)(void* data, uint32_t index));

template <class F>
void parallelFor(uint32_t count, F&& f)
{
    using Function = std::remove_reference_t<F>;
    const auto call = [](void* data, uint32_t index) { (*static_cast<Function*>(data))(index); };
    parallelFor(count, const_cast<void*>(static_cast<const void*>(&f)), call);
}

} // namespace penumbra::ecs
