// ecs/systems7: seven small systems over 12 kinds of entity. The plain twin has a set of arrays per
// kind and, in each system, a loop over the kinds that have what it needs.
#include "tests/bench/ecs_bench.h"

namespace penumbra::ecs::bench {

namespace {

struct Spin {
    static constexpr std::string_view kName = "bench.Spin";
    float angle = 0, speed = 1;
};
struct Damage {
    static constexpr std::string_view kName = "bench.Damage";
    float perSecond = 0.5f;
};
struct Radius {
    static constexpr std::string_view kName = "bench.Radius";
    float metres = 1;
};
struct Box {
    static constexpr std::string_view kName = "bench.Box";
    using Lane = float;
    float lowX = 0, lowY = 0, lowZ = 0, highX = 0, highY = 0, highZ = 0;
};
struct Tint {
    static constexpr std::string_view kName = "bench.Tint";
    float red = 0;
};

// What a kind has besides Position, Velocity and Health. 12 combinations, spread evenly.
struct Kind {
    bool spin, damage, box, tint;
};
constexpr std::array<Kind, 12> kKinds{{{0, 0, 0, 0},
                                       {1, 0, 0, 0},
                                       {0, 1, 0, 0},
                                       {0, 0, 1, 0},
                                       {0, 0, 0, 1},
                                       {1, 1, 0, 0},
                                       {0, 1, 1, 0},
                                       {0, 0, 1, 1},
                                       {1, 0, 0, 1},
                                       {1, 1, 1, 0},
                                       {0, 1, 1, 1},
                                       {1, 1, 1, 1}}};

void move(Position& p, const Velocity& v)
{
    p.x += v.x * kStep;
    p.y += v.y * kStep;
    p.z += v.z * kStep;
}
void drag(Velocity& v)
{
    v.x = v.x * 0.999f + 0.001f; // towards 1: no denormals, however long it runs
    v.y = v.y * 0.999f + 0.001f;
    v.z = v.z * 0.999f + 0.001f;
}
void heal(Health& h)
{
    h.points = std::min(h.points + kStep, 100.0f);
}
void hurt(Health& h, const Damage& d)
{
    h.points = std::max(h.points - d.perSecond * kStep, 0.0f);
}
void spin(Spin& s)
{
    s.angle += s.speed * kStep;
}
void bound(Box& b, const Position& p, const Radius& r)
{
    b = {p.x - r.metres, p.y - r.metres, p.z - r.metres,
         p.x + r.metres, p.y + r.metres, p.z + r.metres};
}
void tint(Tint& t, const Health& h)
{
    t.red = 1 - h.points * 0.01f;
}

struct WorldKinds {
    World world;
    std::vector<Entity> last; // of each kind
};

void fillWorld(WorldKinds& kinds, size_t n)
{
    for (size_t k = 0; k < kKinds.size(); ++k) {
        std::vector<Entity> entities(n * (k + 1) / kKinds.size() - n * k / kKinds.size());
        kinds.world.createMany(entities, Position{}, Velocity{1, 2, 3}, Health{50});
        for (const Entity entity : entities) {
            if (kKinds[k].spin)
                kinds.world.add(entity, Spin{});
            if (kKinds[k].damage)
                kinds.world.add(entity, Damage{});
            if (kKinds[k].box)
                kinds.world.add(entity, Radius{}, Box{});
            if (kKinds[k].tint)
                kinds.world.add(entity, Tint{});
        }
        kinds.last.push_back(entities.back());
    }
}

void systemsWorld(benchmark::State& state, size_t n)
{
    WorldKinds kinds;
    fillWorld(kinds, n);
    World& world = kinds.world;
    for (auto _ : state) {
        world.query<Position, const Velocity>().each(
            [](Position& p, const Velocity& v) { move(p, v); });
        world.query<Velocity>().each([](Velocity& v) { drag(v); });
        world.query<Health>().each([](Health& h) { heal(h); });
        world.query<Health, const Damage>().each([](Health& h, const Damage& d) { hurt(h, d); });
        world.query<Spin>().each([](Spin& s) { spin(s); });
        world.query<Box, const Position, const Radius>().each(
            [](Box& b, const Position& p, const Radius& r) { bound(b, p, r); });
        world.query<Tint, const Health>().each([](Tint& t, const Health& h) { tint(t, h); });
        world.advance();
    }
    items(state, n);
    check(state, world.query<Position>().count() == n &&
                     world.value<Position>(kinds.last.back()).x > 0 &&
                     world.value<Box>(kinds.last.back()).highX > 1 &&
                     world.get<const Spin>(kinds.last.back()).angle > 0 &&
                     world.get<const Tint>(kinds.last.back()).red != 0);
}

struct PlainKind {
    Kind has;
    size_t n;
    std::vector<float> px, py, pz, vx, vy, vz, health, damage, radius, tint;
    std::array<std::vector<float>, 6> box;
    std::vector<Spin> spin;
    PlainKind(Kind kind, size_t count)
        : has(kind), n(count), px(n), py(n), pz(n), vx(n, 1), vy(n, 2), vz(n, 3), health(n, 50),
          damage(n, 0.5f), radius(n, 1), tint(n), spin(n)
    {
        box.fill(std::vector<float>(n));
    }
};

// One function per system with __restrict parameters: what a careful plain program has.
[[gnu::noinline]] void dragAll(float* __restrict vx, float* __restrict vy, float* __restrict vz,
                               size_t n)
{
    for (size_t i = 0; i < n; ++i) {
        vx[i] = vx[i] * 0.999f + 0.001f;
        vy[i] = vy[i] * 0.999f + 0.001f;
        vz[i] = vz[i] * 0.999f + 0.001f;
    }
}
[[gnu::noinline]] void healAll(float* __restrict health, size_t n)
{
    for (size_t i = 0; i < n; ++i)
        health[i] = std::min(health[i] + kStep, 100.0f);
}
[[gnu::noinline]] void hurtAll(float* __restrict health, const float* __restrict damage, size_t n)
{
    for (size_t i = 0; i < n; ++i)
        health[i] = std::max(health[i] - damage[i] * kStep, 0.0f);
}
[[gnu::noinline]] void spinAll(Spin* __restrict spins, size_t n)
{
    for (size_t i = 0; i < n; ++i)
        spin(spins[i]);
}
[[gnu::noinline]] void boundAll(float* __restrict lowX, float* __restrict lowY,
                                float* __restrict lowZ, float* __restrict highX,
                                float* __restrict highY, float* __restrict highZ,
                                const float* __restrict px, const float* __restrict py,
                                const float* __restrict pz, const float* __restrict radius,
                                size_t n)
{
    for (size_t i = 0; i < n; ++i) {
        lowX[i] = px[i] - radius[i];
        lowY[i] = py[i] - radius[i];
        lowZ[i] = pz[i] - radius[i];
        highX[i] = px[i] + radius[i];
        highY[i] = py[i] + radius[i];
        highZ[i] = pz[i] + radius[i];
    }
}
[[gnu::noinline]] void tintAll(float* __restrict tints, const float* __restrict health, size_t n)
{
    for (size_t i = 0; i < n; ++i)
        tints[i] = 1 - health[i] * 0.01f;
}

void systemsPlain(benchmark::State& state, size_t n)
{
    std::vector<PlainKind> kinds;
    for (size_t k = 0; k < kKinds.size(); ++k)
        kinds.emplace_back(kKinds[k], n * (k + 1) / kKinds.size() - n * k / kKinds.size());
    for (auto _ : state) {
        for (PlainKind& k : kinds)
            movePlain(k.px.data(), k.py.data(), k.pz.data(), k.vx.data(), k.vy.data(), k.vz.data(),
                      k.n);
        for (PlainKind& k : kinds)
            dragAll(k.vx.data(), k.vy.data(), k.vz.data(), k.n);
        for (PlainKind& k : kinds)
            healAll(k.health.data(), k.n);
        for (PlainKind& k : kinds)
            if (k.has.damage)
                hurtAll(k.health.data(), k.damage.data(), k.n);
        for (PlainKind& k : kinds)
            if (k.has.spin)
                spinAll(k.spin.data(), k.n);
        for (PlainKind& k : kinds)
            if (k.has.box)
                boundAll(k.box[0].data(), k.box[1].data(), k.box[2].data(), k.box[3].data(),
                         k.box[4].data(), k.box[5].data(), k.px.data(), k.py.data(), k.pz.data(),
                         k.radius.data(), k.n);
        for (PlainKind& k : kinds)
            if (k.has.tint)
                tintAll(k.tint.data(), k.health.data(), k.n);
        benchmark::ClobberMemory();
    }
    items(state, n);
    const PlainKind& last = kinds.back();
    check(state, last.px.back() > 0 && last.box[3].back() > 1 && last.spin.back().angle > 0 &&
                     last.tint.back() != 0);
}

const int kRegistered = [] {
    for (const size_t n : {1'000, 65'000}) {
        variant("systems7", n, "world", systemsWorld);
        variant("systems7", n, "plain", systemsPlain);
    }
    return 0;
}();

} // namespace

} // namespace penumbra::ecs::bench
