// ecs/update2, ecs/update2_2threads, ecs/fragments26: walking rows.
#include "tests/bench/ecs_bench.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <map>

namespace penumbra::ecs::bench {

namespace {

// --- update2: position += velocity * step.
struct PlainBodies {
    std::vector<float> px, py, pz, vx, vy, vz;
    explicit PlainBodies(size_t n) : px(n), py(n), pz(n), vx(n, 1), vy(n, 2), vz(n, 3) {}
};

void updateRange(PlainBodies& b, size_t first, size_t count)
{
    movePlain(b.px.data() + first, b.py.data() + first, b.pz.data() + first, b.vx.data() + first,
              b.vy.data() + first, b.vz.data() + first, count);
}

constexpr auto kUpdate = [](Position& p, const Velocity& v) {
    p.x += v.x * kStep;
    p.y += v.y * kStep;
    p.z += v.z * kStep;
};

// Made once per size and kept: repetitions then differ in time, not in placement.
template <class Fixture>
Fixture& kept(size_t size)
{
    static std::map<size_t, std::unique_ptr<Fixture>> all;
    std::unique_ptr<Fixture>& one = all[size];
    if (!one)
        one = std::make_unique<Fixture>(size);
    return *one;
}

struct WorldBodies {
    World world;
    std::vector<Entity> entities;
    explicit WorldBodies(size_t n) : entities(n)
    {
        world.createMany(entities, Position{}, Velocity{1, 2, 3});
    }
};

template <class Walk>
void runWorldUpdate(benchmark::State& state, size_t n, Walk walk)
{
    auto& [world, entities] = kept<WorldBodies>(n);
    const float before = world.value<Position>(entities.back()).z;
    uint64_t frames = 0;
    for (auto _ : state) {
        walk(world.query<Position, const Velocity>());
        world.advance();
        ++frames;
    }
    items(state, n);
    const Position last = world.value<Position>(entities.back());
    check(state, world.count() == n && last.z > before && last.z <= before + 3 * kStep * frames);
    for (const Entity entity : entities) // floats must not saturate over many repetitions
        world.set(entity, Position{});
}

template <class Walk>
void runPlainUpdate(benchmark::State& state, size_t n, Walk walk)
{
    auto& bodies = kept<PlainBodies>(n);
    const float before = bodies.pz.back();
    for (auto _ : state) {
        walk(bodies);
        benchmark::ClobberMemory();
    }
    items(state, n);
    check(state, bodies.pz.size() == n && bodies.pz.back() > before);
    for (auto* lane : {&bodies.px, &bodies.py, &bodies.pz})
        std::fill(lane->begin(), lane->end(), 0.0f);
}

void update2World(benchmark::State& state, size_t n)
{
    runWorldUpdate(state, n, [](auto query) { query.each(kUpdate); });
}
void update2Plain(benchmark::State& state, size_t n)
{
    runPlainUpdate(state, n, [n](PlainBodies& bodies) { updateRange(bodies, 0, n); });
}
void threadsWorld(benchmark::State& state, size_t n)
{
    const tbb::global_control two(tbb::global_control::max_allowed_parallelism, 2);
    runWorldUpdate(state, n, [](auto query) { query.parallelEach(kUpdate); });
}
void threadsPlain(benchmark::State& state, size_t n)
{
    const tbb::global_control two(tbb::global_control::max_allowed_parallelism, 2);
    runPlainUpdate(state, n, [n](PlainBodies& bodies) {
        tbb::parallel_for(tbb::blocked_range<size_t>(0, n, 4096), [&](const auto& range) {
            updateRange(bodies, range.begin(), range.size());
        });
    });
}

// --- fragments26: the same over 26 archetypes of n rows; the plain twin has one list.
template <uint32_t kLetter>
struct Letter {
    static constexpr std::array<char, 7> kText{'b', 'e', 'n', 'c', 'h', '.', 'A' + kLetter};
    static constexpr std::string_view kName{kText.data(), kText.size()};
    float value = 0;
};

void fragmentsWorld(benchmark::State& state, size_t n)
{
    World world;
    std::vector<Entity> entities(n);
    [&]<uint32_t... k>(std::integer_sequence<uint32_t, k...>)
    {
        (world.createMany(entities, Position{}, Velocity{1, 2, 3}, Letter<k>{}), ...);
    }
    (std::make_integer_sequence<uint32_t, 26>());
    for (auto _ : state) {
        world.query<Position, const Velocity>().each(kUpdate);
        world.advance();
    }
    items(state, n * 26);
    check(state, world.query<Position>().count() == n * 26 &&
                     world.value<Position>(entities.back()).z > 0);
}

void fragmentsPlain(benchmark::State& state, size_t n)
{
    PlainBodies bodies(n * 26);
    for (auto _ : state) {
        updateRange(bodies, 0, n * 26);
        benchmark::ClobberMemory();
    }
    items(state, n * 26);
    check(state, bodies.pz.back() > 0);
}

const int kRegistered = [] {
    for (const size_t n : {10'000, 100'000, 1'000'000, 4'000'000}) {
        variant("update2", n, "world", update2World);
        variant("update2", n, "plain", update2Plain);
    }
    variant("update2_2threads", 1'000'000, "world", threadsWorld)->UseRealTime();
    variant("update2_2threads", 1'000'000, "plain", threadsPlain)->UseRealTime();
    variant("fragments26", 20, "world", fragmentsWorld);
    variant("fragments26", 20, "plain", fragmentsPlain);
    return 0;
}();

} // namespace

} // namespace penumbra::ecs::bench
