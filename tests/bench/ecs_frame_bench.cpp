// ecs/hierarchy and ecs/gather_*: what a renderer asks of a world each frame.
#include "tests/bench/ecs_bench.h"

namespace penumbra::ecs::bench {

namespace {

// --- hierarchy: n roots with 10 children each; global = parent's global x local.
struct Affine {
    float m[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
};
Affine operator*(const Affine& a, const Affine& b)
{
    Affine out;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            out.m[row][column] = a.m[row][0] * b.m[0][column] + a.m[row][1] * b.m[1][column] +
                                 a.m[row][2] * b.m[2][column] + (column == 3 ? a.m[row][3] : 0);
    return out;
}
struct Local {
    static constexpr std::string_view kName = "bench.Local";
    Affine parentFromNode;
};
struct Global {
    static constexpr std::string_view kName = "bench.Global";
    Affine worldFromNode;
};

constexpr size_t kChildren = 10;

Local shifted(float x)
{
    Local local;
    local.parentFromNode.m[0][3] = x;
    return local;
}

void hierarchyWorld(benchmark::State& state, size_t n)
{
    World world;
    std::vector<Entity> roots(n), children(kChildren);
    world.createMany(roots, shifted(1), Global{});
    for (const Entity root : roots)
        world.createMany(children, shifted(2), Global{}, Parent{root});
    for (auto _ : state) {
        world.query<Global, const Local>().eachDown(
            world.hierarchy(), [](Global& global, const Local& local, const Global* parent) {
                global.worldFromNode = parent != nullptr
                                           ? parent->worldFromNode * local.parentFromNode
                                           : local.parentFromNode;
            });
        world.advance();
    }
    items(state, n * (kChildren + 1));
    check(state, world.hierarchy().order().size() == n * (kChildren + 1) &&
                     world.get<const Global>(children.back()).worldFromNode.m[0][3] == 3);
}

void hierarchyPlain(benchmark::State& state, size_t n)
{
    const size_t count = n * (kChildren + 1);
    std::vector<Local> locals(n, shifted(1));
    locals.resize(count, shifted(2));
    std::vector<Global> globals(count);
    std::vector<uint32_t> parents(count, kNone); // parents first
    for (size_t i = n; i < count; ++i)
        parents[i] = static_cast<uint32_t>((i - n) / kChildren);
    for (auto _ : state) {
        for (size_t i = 0; i < count; ++i)
            globals[i].worldFromNode =
                parents[i] != kNone ? globals[parents[i]].worldFromNode * locals[i].parentFromNode
                                    : locals[i].parentFromNode;
        benchmark::ClobberMemory();
    }
    items(state, count);
    check(state, globals.back().worldFromNode.m[0][3] == 3);
}

// --- gather: world bounds of what moved, and a copy for upload of what changed.
struct Placement {
    static constexpr std::string_view kName = "bench.Placement";
    static constexpr bool kRowChanges = true;
    float x = 0, y = 0, z = 0, scale = 1;
    float rotation[4] = {0, 0, 0, 1};
};
struct Sphere {
    float x = 0, y = 0, z = 0, radius = 0;
};
struct LocalSphere {
    static constexpr std::string_view kName = "bench.LocalSphere";
    Sphere sphere{1, 0, 0, 1};
};
struct WorldSphere {
    static constexpr std::string_view kName = "bench.WorldSphere";
    Sphere sphere;
};
struct Instance {
    Placement placement;
    Sphere sphere;
    uint32_t id;
};

[[gnu::always_inline]] inline Sphere boundOf(const Placement& p, const Sphere& s)
{
    const float* q = p.rotation; // v + 2 q x (q x v + w v)
    const float cx = q[1] * s.z - q[2] * s.y + q[3] * s.x;
    const float cy = q[2] * s.x - q[0] * s.z + q[3] * s.y;
    const float cz = q[0] * s.y - q[1] * s.x + q[3] * s.z;
    return {p.x + p.scale * (s.x + 2 * (q[1] * cz - q[2] * cy)),
            p.y + p.scale * (s.y + 2 * (q[2] * cx - q[0] * cz)),
            p.z + p.scale * (s.z + 2 * (q[0] * cy - q[1] * cx)), p.scale * s.radius};
}

struct WorldScene {
    World world;
    std::vector<Entity> entities;
    std::vector<Instance> out;
    explicit WorldScene(size_t n) : entities(n), out(n)
    {
        world.createMany(entities, Placement{}, LocalSphere{}, WorldSphere{});
    }
};
struct PlainScene {
    PlainIds ids;
    std::vector<Placement> placement;
    std::vector<Sphere> local, bounds;
    std::vector<uint8_t> dirty;      // [row]
    std::vector<uint32_t> dirtyRows; // in the order of the writes
    std::vector<Instance> out;
    explicit PlainScene(size_t n)
        : ids(n), placement(n), local(n, LocalSphere{}.sphere), bounds(n), dirty(n), out(n)
    {
        while (!ids.full())
            ids.add();
        dirtyRows.reserve(n);
    }
};

void gatherAllWorld(benchmark::State& state, size_t n)
{
    WorldScene scene(n);
    size_t gathered = 0;
    for (auto _ : state) {
        gathered = 0;
        scene.world.query<const Placement, const LocalSphere, WorldSphere>().each(
            [](const Placement& p, const LocalSphere& local, WorldSphere& bounds) {
                bounds.sphere = boundOf(p, local.sphere);
            });
        scene.world.query<const Placement, const WorldSphere>().each(
            [&, out = scene.out.data()](Entity entity, const Placement& p,
                                        const WorldSphere& bounds) {
                out[gathered++] = {p, bounds.sphere, entity.index};
            });
        scene.world.advance();
        benchmark::ClobberMemory();
    }
    items(state, n);
    check(state, gathered == n && scene.out.back().sphere.x == 1);
}

[[gnu::noinline]] void boundAll(const Placement* __restrict placement,
                                const Sphere* __restrict local, Sphere* __restrict bounds, size_t n)
{
    for (size_t i = 0; i < n; ++i)
        bounds[i] = boundOf(placement[i], local[i]);
}

[[gnu::noinline]] size_t copyAll(const Placement* __restrict placement,
                                 const Sphere* __restrict bounds, const uint32_t* __restrict ids,
                                 Instance* __restrict out, size_t n)
{
    for (size_t i = 0; i < n; ++i)
        out[i] = {placement[i], bounds[i], ids[i]};
    return n;
}

void gatherAllPlain(benchmark::State& state, size_t n)
{
    PlainScene scene(n);
    size_t gathered = 0;
    for (auto _ : state) {
        boundAll(scene.placement.data(), scene.local.data(), scene.bounds.data(), n);
        gathered = copyAll(scene.placement.data(), scene.bounds.data(), scene.ids.ids.data(),
                           scene.out.data(), n);
        benchmark::ClobberMemory();
    }
    items(state, n);
    check(state, gathered == n && scene.out.back().sphere.x == 1);
}

// 1 % of the rows are written by id, then their bounds follow and they are copied out.
constexpr auto kOnePercent = [](size_t n, bool scattered) {
    std::vector<uint32_t> rows(n);
    std::iota(rows.begin(), rows.end(), 0);
    if (scattered)
        rows = shuffled(std::move(rows));
    rows.resize(n / 100);
    return rows;
};

template <bool kScattered>
void gatherSomeWorld(benchmark::State& state, size_t n)
{
    WorldScene scene(n);
    World& world = scene.world;
    std::vector<Entity> chosen;
    for (const uint32_t row : kOnePercent(n, kScattered))
        chosen.push_back(scene.entities[row]);
    uint64_t seen = world.version();
    world.advance();
    size_t gathered = 0;
    bool done = true;
    for (auto _ : state) {
        for (const Entity entity : chosen)
            world.get<Placement>(entity).x += kStep;
        gathered = 0;
        world.query<const Placement, const LocalSphere, WorldSphere, Changed<Placement>>()
            .since(seen)
            .each([&, out = scene.out.data()](Entity entity, const Placement& p,
                                              const LocalSphere& local, WorldSphere& bounds) {
                bounds.sphere = boundOf(p, local.sphere);
                out[gathered++] = {p, bounds.sphere, entity.index};
            });
        seen = world.version();
        world.advance();
        benchmark::ClobberMemory();
        done = done && gathered == chosen.size();
    }
    items(state, n / 100);
    check(state, done && world.get<const WorldSphere>(chosen.back()).sphere.x > 1);
}

template <bool kScattered>
void gatherSomePlain(benchmark::State& state, size_t n)
{
    PlainScene scene(n);
    const std::vector<uint32_t> chosen = kOnePercent(n, kScattered);
    size_t gathered = 0;
    bool done = true;
    for (auto _ : state) {
        for (const uint32_t id : chosen) {
            const uint32_t row = scene.ids.rowOf[id];
            scene.placement[row].x += kStep;
            if (scene.dirty[row] == 0) {
                scene.dirty[row] = 1;
                scene.dirtyRows.push_back(row);
            }
        }
        gathered = 0;
        for (const uint32_t row : scene.dirtyRows) {
            scene.bounds[row] = boundOf(scene.placement[row], scene.local[row]);
            scene.out[gathered++] = {scene.placement[row], scene.bounds[row], scene.ids.ids[row]};
            scene.dirty[row] = 0;
        }
        scene.dirtyRows.clear();
        benchmark::ClobberMemory();
        done = done && gathered == chosen.size();
    }
    items(state, n / 100);
    check(state, done && scene.bounds[scene.ids.rowOf[chosen.back()]].x > 1);
}

// Nothing changed: the time of a whole frame's question.
void gatherNoneWorld(benchmark::State& state, size_t n)
{
    WorldScene scene(n);
    const uint64_t seen = scene.world.version();
    size_t gathered = 0;
    for (auto _ : state) {
        scene.world.advance();
        scene.world.query<const Placement, const WorldSphere, Changed<Placement>>()
            .since(seen)
            .each([&](const Placement&, const WorldSphere&) { ++gathered; });
        benchmark::ClobberMemory();
    }
    items(state, 1);
    const uint64_t before = scene.world.version();
    scene.world.advance();
    scene.world.get<Placement>(scene.entities[n / 2]).x += 1;
    size_t changed = 0;
    scene.world.query<const Placement, Changed<Placement>>().since(before).each(
        [&](const Placement&) { ++changed; });
    check(state, gathered == 0 && changed == 1);
}

void gatherNonePlain(benchmark::State& state, size_t n)
{
    PlainScene scene(n);
    size_t gathered = 0;
    for (auto _ : state) {
        for (const uint32_t row : scene.dirtyRows) {
            scene.out[gathered++] = {scene.placement[row], scene.bounds[row], scene.ids.ids[row]};
            scene.dirty[row] = 0;
        }
        scene.dirtyRows.clear();
        benchmark::ClobberMemory();
    }
    items(state, 1);
    check(state, gathered == 0);
}

const int kRegistered = [] {
    variant("hierarchy", 10'000, "world", hierarchyWorld);
    variant("hierarchy", 10'000, "plain", hierarchyPlain);
    variant("gather_all", 10'000, "world", gatherAllWorld);
    variant("gather_all", 10'000, "plain", gatherAllPlain);
    variant("gather_1pct_scattered", 100'000, "world", gatherSomeWorld<true>);
    variant("gather_1pct_scattered", 100'000, "plain", gatherSomePlain<true>);
    variant("gather_1pct_contiguous", 100'000, "world", gatherSomeWorld<false>);
    variant("gather_1pct_contiguous", 100'000, "plain", gatherSomePlain<false>);
    variant("gather_none", 100'000, "world", gatherNoneWorld);
    variant("gather_none", 100'000, "plain", gatherNonePlain);
    return 0;
}();

} // namespace

} // namespace penumbra::ecs::bench
