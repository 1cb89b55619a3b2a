// What the ECS workloads share: components, the plain twin's id table, and how variants register.
//
// A workload is ecs/NAME/SIZE/{world,plain}. `plain` is what a program would write that has arrays
// of structs-of-arrays and no ECS, doing the same logical work. Both run in one process; compare
// them with --benchmark_enable_random_interleaving=true --benchmark_repetitions=9. Each checks in
// the end that the work was done.
#pragma once

#include "runtime/ecs/world.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <random>
#include <string>

namespace penumbra::ecs::bench {

struct Position { // x, y, z in columns of their own
    static constexpr std::string_view kName = "bench.Position";
    using Lane = float;
    float x = 0, y = 0, z = 0;
};
struct Velocity {
    static constexpr std::string_view kName = "bench.Velocity";
    using Lane = float;
    float x = 0, y = 0, z = 0;
};
struct Orientation {
    static constexpr std::string_view kName = "bench.Orientation";
    float x = 0, y = 0, z = 0, w = 1;
};
struct Health {
    static constexpr std::string_view kName = "bench.Health";
    float points = 0;
};

inline constexpr float kStep = 1.0f / 64; // exact, so that sums can be checked

// Name, and how many logical items one iteration handles: printed as time per item.
inline void items(benchmark::State& state, size_t count)
{
    state.counters["perItem"] = benchmark::Counter(static_cast<double>(count),
                                                   benchmark::Counter::kIsIterationInvariantRate |
                                                       benchmark::Counter::kInvert);
}

inline void check(benchmark::State& state, bool done)
{
    if (!done)
        state.SkipWithError("the work was not done");
}

template <class Run>
benchmark::internal::Benchmark* variant(const char* workload, size_t size, const char* name,
                                        Run run)
{
    const std::string all =
        std::string("ecs/") + workload + "/" + std::to_string(size) + "/" + name;
    return benchmark::RegisterBenchmark(all.c_str(),
                                        [size, run](benchmark::State& state) { run(state, size); });
}

template <class T>
std::vector<T> shuffled(std::vector<T> values)
{
    std::shuffle(values.begin(), values.end(), std::mt19937(7));
    return values;
}

// Rows found by id, ids reused: what every plain program with lists of objects keeps.
struct PlainIds {
    std::vector<uint32_t> ids;   // [row]
    std::vector<uint32_t> rowOf; // [id]
    std::vector<uint32_t> free;
    uint32_t count = 0;

    explicit PlainIds(size_t capacity) : ids(capacity), rowOf(capacity)
    {
        free.reserve(capacity);
        clear();
    }
    void clear()
    {
        count = 0;
        free.resize(ids.size());
        std::iota(free.rbegin(), free.rend(), 0);
    }
    [[nodiscard]] bool full() const { return count == ids.size(); }
    // The id of the new last row.
    uint32_t add()
    {
        const uint32_t id = free.back();
        free.pop_back();
        ids[count] = id;
        rowOf[id] = count++;
        return id;
    }
    // The row that the last one is to fill.
    uint32_t remove(uint32_t id)
    {
        const uint32_t row = rowOf[id];
        ids[row] = ids[--count];
        rowOf[ids[row]] = row;
        free.push_back(id);
        return row;
    }
};

// position += velocity * step, with __restrict parameters: what a careful plain program has.
[[gnu::noinline]] inline void movePlain(float* __restrict px, float* __restrict py,
                                        float* __restrict pz, const float* __restrict vx,
                                        const float* __restrict vy, const float* __restrict vz,
                                        size_t n)
{
    for (size_t i = 0; i < n; ++i) {
        px[i] += vx[i] * kStep;
        py[i] += vy[i] * kStep;
        pz[i] += vz[i] * kStep;
    }
}

} // namespace penumbra::ecs::bench
