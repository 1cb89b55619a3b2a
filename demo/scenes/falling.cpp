#include "demo/scenes/falling.h"

#include <algorithm>
#include <glm/gtc/constants.hpp>

namespace penumbra {

namespace {

enum class Hull { Convex, Pieces };

struct Kind {
    const char* asset;
    float size; // largest side of the bounding box, metres
    Hull hull;
    int count;
};

// 20 objects. The bunny alone has 35 thousand vertices, so there is one of it.
constexpr Kind kKinds[] = {
    {"bunny", 0.62f, Hull::Convex, 1},  {"knight", 0.50f, Hull::Pieces, 3},
    {"teapot", 0.52f, Hull::Pieces, 3}, {"torus_knot", 0.50f, Hull::Pieces, 3},
    {"gear", 0.46f, Hull::Convex, 3},   {"chess_pawn", 0.44f, Hull::Pieces, 2},
    {"mug", 0.36f, Hull::Pieces, 3},    {"rounded_cube", 0.32f, Hull::Convex, 2},
};

struct Look {
    vec3 albedo;
    float glossFraction, glossExponent;
};
// Exponents that order 4 can carry: at 4, the lobe times P_4 integrates to an eighth of the lobe
// itself.
constexpr Look kLooks[] = {
    {{0.72f, 0.70f, 0.66f}, 0, 0},     {{0.70f, 0.28f, 0.18f}, 0, 0},
    {{0.20f, 0.42f, 0.62f}, 0.45f, 4}, {{0.78f, 0.60f, 0.22f}, 0.5f, 4},
    {{0.30f, 0.55f, 0.32f}, 0, 0},     {{0.55f, 0.24f, 0.45f}, 0.35f, 4},
    {{0.75f, 0.72f, 0.70f}, 0.5f, 4},  {{0.18f, 0.55f, 0.55f}, 0, 0},
};

// SplitMix64 (Steele et al. 2014): a scene must not depend on the library's generators.
class Random {
public:
    explicit Random(std::uint64_t seed) : m_state(seed) {}
    float uniform(float low, float high)
    {
        return low + (high - low) * static_cast<float>(next() >> 40) * 0x1p-24f;
    }

private:
    std::uint64_t next()
    {
        std::uint64_t z = m_state += 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    std::uint64_t m_state;
};

// Uniform over rotations (Shoemake 1992).
quat randomRotation(Random& random)
{
    const float u = random.uniform(0, 1), a = random.uniform(0, 2 * glm::pi<float>()),
                b = random.uniform(0, 2 * glm::pi<float>());
    return quat(std::sqrt(u) * std::cos(b), std::sqrt(1 - u) * std::sin(a),
                std::sqrt(1 - u) * std::cos(a), std::sqrt(u) * std::sin(b));
}

struct LoadedKind {
    AssetHandle asset;
    float scale = 1;
    CollisionShape shape;
};

Result<LoadedKind> loadKind(const Kind& kind, const SceneOptions& options, AssetStore& store)
{
    Result<AssetHandle> asset = store.loadMesh(options.assets / (std::string(kind.asset) + ".glb"));
    if (!asset)
        return asset.error();
    const MeshAsset& mesh = store.mesh(*asset);
    if (!mesh.field)
        return Error{
            fmt::format("{}.glb: has no shadow field; bake it without --no-field", kind.asset)};
    const vec3 extent = mesh.boundsMax - mesh.boundsMin;
    const float scale = kind.size / std::max({extent.x, extent.y, extent.z});

    // Bullet's shapes are not scaled afterwards: scale the points.
    std::vector<vec3> points;
    for (const vec3& p : mesh.positions)
        points.push_back(p * scale);
    Result<CollisionShape> shape =
        kind.hull == Hull::Pieces
            ? meshShape(points, mesh.indices, {.maxPieces = 14, .resolution = 32})
            : hullShape(points);
    if (!shape)
        return fail(shape.error(), kind.asset);
    return LoadedKind{*asset, scale, std::move(*shape)};
}

} // namespace

Result<std::unique_ptr<DemoScene>> loadFallingScene(const SceneOptions& options)
{
    Result<std::unique_ptr<DemoScene>> made = makeFloorScene(options, "falling", "sunset");
    if (!made)
        return made;
    std::unique_ptr<DemoScene> scene = std::move(*made);
    scene->exposure = 1.6f;
    scene->camera = {.target = vec3(0, 0.22f, 0),
                     .distance = 4.1f,
                     .yaw = 0.55f,
                     .pitch = 0.52f,
                     .fieldOfView = 0.62f};

    std::vector<LoadedKind> kinds;
    for (const Kind& kind : kKinds) {
        Result<LoadedKind> loaded = loadKind(kind, options, scene->assets);
        if (!loaded)
            return loaded.error();
        kinds.push_back(std::move(*loaded));
    }

    // One object per slot of a 3 x 3 x 3 lattice above the floor, from below, kinds in turn, each
    // jittered and turned: they start apart whatever the seed.
    Random random(options.seed);
    std::vector<BodyDescription> bodies{{.id = 0, .shape = *groundShape(0)}};
    int remaining[std::size(kKinds)], slot = 0;
    for (std::size_t k = 0; k < std::size(kKinds); ++k)
        remaining[k] = kKinds[k].count;
    for (bool placed = true; placed;) {
        placed = false;
        for (std::size_t k = 0; k < std::size(kKinds); ++k) {
            if (remaining[k]-- <= 0)
                continue;
            placed = true;
            const int column = slot % 9, layer = slot / 9;
            const quat rotation = randomRotation(random);
            const auto row = column / 3;
            const vec3 position(
                (static_cast<float>(column % 3) - 1) * 0.72f + random.uniform(-0.06f, 0.06f),
                0.55f + static_cast<float>(layer) * 0.75f + random.uniform(0, 0.1f),
                (static_cast<float>(row) - 1) * 0.72f + random.uniform(-0.06f, 0.06f));
            BodyDescription body{.id = static_cast<std::uint64_t>(slot) + 1,
                                 .shape = kinds[k].shape};
            constexpr float kDensity = 300; // kg/m³: light wood; only the ratios matter here
            body.mass = std::max(0.2f, kDensity * body.shape.volume());
            body.pose = {position, rotation};
            body.motion.angularVelocity =
                vec3(random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3));
            const Look& look = kLooks[static_cast<std::size_t>(slot) % std::size(kLooks)];
            scene->world.create(Transform{position, kinds[k].scale,
                                          vec4(rotation.x, rotation.y, rotation.z, rotation.w)},
                                MeshInstance{kinds[k].asset}, ShadowFieldOccluder{kinds[k].asset},
                                RigidBody{body.id},
                                Material{look.albedo, look.glossFraction, look.glossExponent});
            bodies.push_back(std::move(body));
            ++slot;
        }
    }
    Result<PhysicsWorld> physics = PhysicsWorld::build(std::move(bodies));
    if (!physics)
        return physics.error();
    scene->physics = std::move(*physics);
    return scene;
}

Result<std::unique_ptr<DemoScene>> loadCoarseScene(const SceneOptions& options)
{
    SceneOptions coarse = options;
    coarse.floor = "floor_coarse";
    Result<std::unique_ptr<DemoScene>> scene = loadFallingScene(coarse);
    if (scene)
        (*scene)->name = "coarse";
    return scene;
}

} // namespace penumbra
