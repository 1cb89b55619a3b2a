// Random systems with random declared accesses on random data: one result at any number of threads.
// PENUMBRA_STRESS_FRAMES sets the number of frames (thread sanitizer: 50 do).
#include "runtime/ecs/schedule.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cstdlib>
#include <random>

namespace penumbra::ecs {

namespace {

constexpr std::array<std::string_view, 4> kNames{"stress.A", "stress.B", "stress.C", "stress.D"};
constexpr uint32_t kKinds = kNames.size();

template <uint32_t k>
struct Cell {
    static constexpr std::string_view kName = kNames[k];
    static constexpr bool kRowChanges = k % 2 == 0;
    uint32_t value = k;
};

uint32_t mix(uint32_t a, uint32_t b)
{
    a = (a ^ b) * 0x9E3779B1u; // golden ratio
    return a ^ (a >> 15);
}

// What one system does, over and over: reads kind r, writes kind w.
struct Step {
    uint32_t r, w, kind, seed;
};

template <uint32_t r, uint32_t w>
void doStep(SystemContext& context, const Step& step)
{
    using R = const Cell<r>;
    using W = Cell<w>;
    const uint32_t seed = step.seed;
    if constexpr (r == w) {
        const auto write = [=](W& to) { to.value = mix(to.value, seed); };
        if (step.kind % 2 == 0)
            context.query<W>().parallelEach(write);
        else
            context.query<W, Changed<W>>().parallelEach(write);
    } else {
        const auto write = [=](W& to, R& from) { to.value = mix(to.value + seed, from.value); };
        switch (step.kind) {
        case 0:
            context.query<W, R>().each(write);
            break;
        case 1:
            context.query<W, R>().parallelEach(write);
            break;
        case 2:
            context.query<W, R, Changed<Cell<r>>>().parallelEach(write);
            break;
        case 3: {
            CommandBuffer& commands = context.commands();
            const auto query = context.query<R, WithDisabled>();
            const bool full = query.count() > 3000;
            query.each([&](Entity entity, R& from) {
                const uint32_t hash = mix(from.value, mix(entity.index, seed));
                if (hash % 256 != 0)
                    return;
                switch ((hash >> 8) % 8) {
                case 0:
                    if (full)
                        return commands.destroy(entity);
                    [[fallthrough]];
                case 1:
                    return commands.setEnabled(entity, (hash & 1 << 20) != 0);
                case 2:
                    return commands.template remove<W>(entity);
                case 3:
                    return static_cast<void>(commands.create(W{hash}, from, Parent{entity}));
                default:
                    return commands.add(entity, W{hash});
                }
            });
            break;
        }
        default: // scattered
            context.query<R>().each([&](Entity entity, R& from) {
                if (mix(from.value, seed) % 16 == 0)
                    if (W* to = context.tryGet<W>(entity))
                        to->value += from.value;
            });
        }
    }
}

using StepFunction = void (*)(SystemContext&, const Step&);
template <size_t... k>
constexpr std::array<StepFunction, sizeof...(k)> makeSteps(std::index_sequence<k...>)
{
    return {doStep<k / kKinds, k % kKinds>...};
}
constexpr auto kSteps = makeSteps(std::make_index_sequence<kKinds * kKinds>());

template <uint32_t k>
void hashKind(World& world, uint64_t& hash)
{
    world.query<const Cell<k>, WithDisabled>().each([&](Entity entity, const Cell<k>& cell) {
        for (const uint64_t word : {uint64_t{entity.index}, uint64_t{entity.generation},
                                    uint64_t{cell.value}, uint64_t{world.isEnabled(entity)},
                                    uint64_t{world.hierarchy().parentOf(entity).index}})
            hash = (hash ^ word) * 0x100000001b3u; // FNV-1a
    });
}

template <size_t... k>
uint64_t hashOf(World& world, std::index_sequence<k...>)
{
    uint64_t hash = 0xcbf29ce484222325u;
    (hashKind<k>(world, hash), ...);
    return hash;
}

template <size_t... k>
ComponentMask maskOf(const std::vector<bool>& wanted, std::index_sequence<k...>)
{
    ComponentMask mask;
    ((wanted[k] ? mask.set(componentId<Cell<k>>()) : void()), ...);
    return mask;
}

std::vector<uint64_t> simulate(uint32_t seed, int threads, uint32_t frames)
{
    tbb::task_arena arena(threads);
    return arena.execute([&] {
        constexpr auto kIndices = std::make_index_sequence<kKinds>();
        World world;
        std::vector<Entity> entities(1500);
        world.createMany(entities, Cell<0>{seed}, Cell<1>{}, Cell<2>{}, Cell<3>{});
        world.createMany(entities, Cell<0>{}, Cell<3>{seed});
        std::mt19937 random(seed); // the same schedule for every number of threads
        const auto below = [&](uint32_t n) { return static_cast<uint32_t>(random() % n); };
        const std::vector<std::string> phases{"one", "two", "three"};
        Schedule schedule(world, phases);
        std::vector<std::vector<std::string>> names(phases.size());
        for (uint32_t i = 0; i < 24; ++i) {
            std::vector<bool> reads(kKinds), writes(kKinds);
            std::vector<Step> steps(1 + below(2));
            for (Step& step : steps) {
                step = {below(kKinds), below(kKinds), below(5), below(1000000)};
                reads[step.r] = true;
                writes[step.w] = true;
            }
            const uint32_t phase = below(3);
            const std::string name = "system " + std::to_string(i);
            SystemOrder order;
            if (below(4) == 0 && !names[phase].empty())
                order.after.push_back(names[phase][below(names[phase].size())]);
            else if (below(8) == 0 &&
                     !names[phase].empty()) // nothing goes before the first: no circle
                order.before.push_back(names[phase].front());
            names[phase].push_back(name);
            const Access access{maskOf(reads, kIndices), maskOf(writes, kIndices)};
            schedule.add(
                name, phases[phase], access,
                [steps](SystemContext& context) {
                    for (const Step& step : steps)
                        kSteps[step.r * kKinds + step.w](context, step);
                },
                order);
        }
        std::vector<uint64_t> hashes;
        for (uint32_t frame = 0; frame < frames; ++frame) {
            const PlaybackStatistics played = schedule.run();
            if (frame % 64 == 0 || frame + 1 == frames)
                hashes.push_back(hashOf(world, kIndices) ^ played.commands);
        }
        EXPECT_GT(world.count(), 500u);
        EXPECT_LT(world.count(), 100000u);
        return hashes;
    });
}

} // namespace

TEST(ScheduleStress, OneResultAtAnyNumberOfThreads)
{
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, 4);
    const char* text = std::getenv("PENUMBRA_STRESS_FRAMES");
    const uint32_t frames = text != nullptr ? static_cast<uint32_t>(std::atoi(text)) : 1000;
    for (const uint32_t seed : {1u, 2u}) {
        const std::vector<uint64_t> one = simulate(seed, 1, frames);
        EXPECT_EQ(simulate(seed, 2, frames), one) << "seed " << seed;
        EXPECT_EQ(simulate(seed, 4, frames), one) << "seed " << seed;
    }
}

} // namespace penumbra::ecs
