#include "demo/scenes/falling.h"

#include "demo/scenes/objects.h"
#include "systems/rotation.h"

#include <glm/gtc/constants.hpp>

namespace penumbra {

namespace {

struct Kind {
    const char* asset;
    float size; // largest side of the bounding box, metres
    BodyShape shape;
    int count;
};

// 20 objects. The bunny alone has 35 thousand vertices, so there is one of it.
constexpr Kind kKinds[] = {
    {"bunny", 0.62f, BodyShape::Hull, 1},    {"knight", 0.50f, BodyShape::Pieces, 3},
    {"teapot", 0.52f, BodyShape::Pieces, 3}, {"torus_knot", 0.50f, BodyShape::Pieces, 3},
    {"gear", 0.46f, BodyShape::Hull, 3},     {"chess_pawn", 0.44f, BodyShape::Pieces, 2},
    {"mug", 0.36f, BodyShape::Pieces, 3},    {"rounded_cube", 0.32f, BodyShape::Hull, 2},
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

} // namespace

Result<std::unique_ptr<DemoScene>> loadFallingScene(const SceneOptions& options)
{
    Result<std::unique_ptr<DemoScene>> made = makeFloorScene(options, "falling", "sunset");
    if (!made)
        return made;
    std::unique_ptr<DemoScene> scene = std::move(*made);
    scene->camera = {.target = vec3(0, 0.22f, 0),
                     .distance = 4.1f,
                     .yaw = 0.55f,
                     .pitch = 0.52f,
                     .fieldOfView = 0.62f,
                     .exposure = 1.6f};

    AssetHandle assets[std::size(kKinds)];
    for (std::size_t k = 0; k < std::size(kKinds); ++k) {
        Result<AssetHandle> asset = loadMesh(*scene, options, kKinds[k].asset);
        if (!asset)
            return asset.error();
        assets[k] = *asset;
    }

    // One object per slot of a 3 x 3 x 3 lattice above the floor, from below, kinds in turn, each
    // jittered and turned: they start apart whatever the seed.
    Random random(options.seed);
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
            const vec3 spin(random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3));
            const Look& look = kLooks[static_cast<std::size_t>(slot) % std::size(kLooks)];
            scene->world.create(Transform{position,
                                          scaleTo(scene->assets.mesh(assets[k]), kKinds[k].size),
                                          toVec4(rotation)},
                                MeshInstance{assets[k]}, ShadowFieldOccluder{assets[k]},
                                RigidBody{.shape = kKinds[k].shape, .angularVelocity = spin},
                                Material{look.albedo, look.glossFraction, look.glossExponent});
            ++slot;
        }
    }
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
