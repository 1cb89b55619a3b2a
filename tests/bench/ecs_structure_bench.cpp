// ecs/create4, ecs/create4_bulk, ecs/destroy, ecs/add_remove, ecs/random_get: entities come, change
// and go. All warm: the memory is there, in the world as in the plain twin, which keeps one array
// per lane, ids that are reused, and the row of each id.
#include "tests/bench/ecs_bench.h"

namespace penumbra::ecs::bench {

namespace {

struct Poison {
    static constexpr std::string_view kName = "bench.Poison";
    float perSecond = 0;
};

// One list of objects in arrays sized once. create() checks room, as it must.
struct PlainList {
    PlainIds ids;
    std::vector<float> px, py, pz, vx, vy, vz, health;
    std::vector<Orientation> orientation;

    explicit PlainList(size_t n)
        : ids(n), px(n), py(n), pz(n), vx(n), vy(n), vz(n), health(n), orientation(n)
    {}
    uint32_t create(const Position& p, const Velocity& v, const Orientation& o, const Health& h)
    {
        if (ids.full())
            std::abort();
        const uint32_t row = ids.count;
        px[row] = p.x;
        py[row] = p.y;
        pz[row] = p.z;
        vx[row] = v.x;
        vy[row] = v.y;
        vz[row] = v.z;
        orientation[row] = o;
        health[row] = h.points;
        return ids.add();
    }
    void destroy(uint32_t id)
    {
        const uint32_t row = ids.remove(id);
        const uint32_t last = ids.count;
        px[row] = px[last];
        py[row] = py[last];
        pz[row] = pz[last];
        vx[row] = vx[last];
        vy[row] = vy[last];
        vz[row] = vz[last];
        orientation[row] = orientation[last];
        health[row] = health[last];
    }
};

Position positionOf(size_t i)
{
    const auto f = static_cast<float>(i);
    return {f, f + 1, f + 2};
}

// n entities of the four components.
struct FullWorld {
    World world;
    std::vector<Entity> entities;
    explicit FullWorld(size_t n) : entities(n)
    {
        world.createMany(entities, Position{}, Velocity{}, Orientation{}, Health{});
    }
};

void createWorld(benchmark::State& state, size_t n)
{
    FullWorld full(n);
    auto& [world, entities] = full;
    bool done = true;
    for (auto _ : state) {
        state.PauseTiming();
        world.destroyMany(entities);
        done = done && world.count() == 0;
        state.ResumeTiming();
        for (size_t i = 0; i < n; ++i)
            entities[i] =
                world.create(positionOf(i), Velocity{1, 2, 3}, Orientation{}, Health{100});
    }
    items(state, n);
    check(state, done && world.count() == n &&
                     world.value<Position>(entities[n / 2]).z == positionOf(n / 2).z &&
                     world.get<const Health>(entities[n - 1]).points == 100);
}

void createPlain(benchmark::State& state, size_t n)
{
    PlainList list(n);
    std::vector<uint32_t> made(n);
    for (auto _ : state) {
        state.PauseTiming();
        list.ids.clear();
        state.ResumeTiming();
        for (size_t i = 0; i < n; ++i)
            made[i] = list.create(positionOf(i), Velocity{1, 2, 3}, Orientation{}, Health{100});
        benchmark::ClobberMemory();
    }
    items(state, n);
    check(state,
          list.ids.count == n && list.pz[list.ids.rowOf[made[n / 2]]] == positionOf(n / 2).z);
}

// The plain twin of bulk creation is the plain creation one by one: ratios count against it.
void createManyWorld(benchmark::State& state, size_t n)
{
    FullWorld full(n);
    auto& [world, entities] = full;
    bool done = true;
    for (auto _ : state) {
        state.PauseTiming();
        world.destroyMany(entities);
        done = done && world.count() == 0;
        state.ResumeTiming();
        world.createMany(
            entities, [](uint32_t i) { return positionOf(i); }, Velocity{1, 2, 3}, Orientation{},
            Health{100});
    }
    items(state, n);
    check(state, done && world.count() == n &&
                     world.value<Position>(entities[n / 2]).z == positionOf(n / 2).z);
}

void destroyWorld(benchmark::State& state, size_t n)
{
    World world;
    std::vector<Entity> entities(n);
    bool done = true;
    for (auto _ : state) {
        state.PauseTiming();
        world.createMany(entities, Position{}, Velocity{}, Orientation{}, Health{});
        const std::vector<Entity> order = shuffled(entities);
        done = done && world.count() == n;
        state.ResumeTiming();
        for (const Entity entity : order)
            world.destroy(entity);
    }
    items(state, n);
    check(state, done && world.count() == 0);
}

void destroyPlain(benchmark::State& state, size_t n)
{
    PlainList list(n);
    std::vector<uint32_t> made(n);
    bool done = true;
    for (auto _ : state) {
        state.PauseTiming();
        for (uint32_t& id : made)
            id = list.create({}, {}, {}, {});
        const std::vector<uint32_t> order = shuffled(made);
        done = done && list.ids.count == n;
        state.ResumeTiming();
        for (const uint32_t id : order)
            list.destroy(id);
        benchmark::ClobberMemory();
    }
    items(state, n);
    check(state, done && list.ids.count == 0);
}

// All get one more component, then all lose it. Plain: values side by side with their owners (a
// sparse set).
void addRemoveWorld(benchmark::State& state, size_t n)
{
    FullWorld full(n);
    auto& [world, entities] = full;
    bool done = true;
    for (auto _ : state) {
        for (const Entity entity : entities)
            world.add(entity, Poison{2});
        done = done && world.query<Poison>().count() == n;
        for (const Entity entity : entities)
            world.remove<Poison>(entity);
        done = done && world.query<Poison>().count() == 0;
    }
    items(state, n);
    check(state, done && world.count() == n);
}

void addRemoveManyWorld(benchmark::State& state, size_t n)
{
    FullWorld full(n);
    auto& [world, entities] = full;
    bool done = true;
    for (auto _ : state) {
        world.addMany(entities, Poison{2});
        done = done && world.query<Poison>().count() == n;
        world.removeMany<Poison>(entities);
        done = done && world.query<Poison>().count() == 0;
    }
    items(state, n);
    check(state, done && world.count() == n);
}

void addRemovePlain(benchmark::State& state, size_t n)
{
    std::vector<Poison> values(n);
    std::vector<uint32_t> owners(n), places(n, kNone);
    bool done = true;
    for (auto _ : state) {
        uint32_t count = 0;
        for (uint32_t id = 0; id < n; ++id) {
            if (places[id] != kNone)
                continue;
            values[count] = {2};
            owners[count] = id;
            places[id] = count++;
            benchmark::ClobberMemory(); // one by one, as the world's
        }
        done = done && count == n;
        for (uint32_t id = 0; id < n; ++id) {
            const uint32_t place = places[id];
            if (place == kNone)
                continue;
            --count;
            values[place] = values[count];
            owners[place] = owners[count];
            places[owners[place]] = place;
            places[id] = kNone;
            benchmark::ClobberMemory();
        }
        done = done && count == 0;
    }
    items(state, n);
    check(state, done);
}

void randomGetWorld(benchmark::State& state, size_t n)
{
    World world;
    std::vector<Entity> entities(n);
    world.createMany(entities, Position{}, Velocity{}, Orientation{1, 0, 0, 0}, Health{});
    entities = shuffled(std::move(entities));
    const World& readOnly = world;
    float sum = 0;
    for (auto _ : state) {
        sum = 0;
        for (const Entity entity : entities)
            sum += readOnly.get<Orientation>(entity).x;
        benchmark::DoNotOptimize(sum);
    }
    items(state, n);
    check(state, sum == static_cast<float>(n));
}

void randomGetPlain(benchmark::State& state, size_t n)
{
    PlainList list(n);
    std::vector<uint32_t> made(n);
    for (uint32_t& id : made)
        id = list.create({}, {}, {1, 0, 0, 0}, {});
    made = shuffled(std::move(made));
    float sum = 0;
    for (auto _ : state) {
        sum = 0;
        for (const uint32_t id : made)
            sum += list.orientation[list.ids.rowOf[id]].x;
        benchmark::DoNotOptimize(sum);
    }
    items(state, n);
    check(state, sum == static_cast<float>(n));
}

const int kRegistered = [] {
    variant("create4", 100'000, "world", createWorld);
    variant("create4", 100'000, "plain", createPlain);
    variant("create4_bulk", 100'000, "world", createManyWorld);
    variant("create4_bulk", 100'000, "plain", createPlain);
    variant("destroy", 100'000, "world", destroyWorld);
    variant("destroy", 100'000, "plain", destroyPlain);
    variant("add_remove", 100'000, "world", addRemoveWorld);
    variant("add_remove", 100'000, "world_bulk", addRemoveManyWorld);
    variant("add_remove", 100'000, "plain", addRemovePlain);
    variant("random_get", 1'000'000, "world", randomGetWorld);
    variant("random_get", 1'000'000, "plain", randomGetPlain);
    return 0;
}();

} // namespace

} // namespace penumbra::ecs::bench
