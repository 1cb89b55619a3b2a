// Scene files: entities as JSON, by the components' descriptions (field.h). Format: the file that
// assetc writes (docs/asset_format.md, "scene.json"), with prefabs and singletons beside it.
//
//   Scene scene; // what a world cannot hold: prefabs, unknown parts of the file
//   Result<LoadedScene> loaded = loadScene(world, scene, text, &assets);
//   if (!loaded) return fail(loaded.error(), path);
//   for (const std::string& warning : loaded->warnings) …
//   Result<SavedScene> saved = saveScene(world, scene, &assets);
//
// Guarantees. A file that is refused changes nothing: the error has the place (a JSON pointer), the
// problem and the remedy. A component or member that this program does not know, or a component of
// a newer version, is kept as JSON in the Scene, reported once, and written back. The same world
// and scene give the same bytes, whatever the order in which components registered; loading what
// was saved into an empty world and saving again gives the same bytes. Components must be
// registered before (registerComponents<…>()), else they count as unknown.
#pragma once

#include "runtime/ecs/prefab.h"
#include "runtime/ecs/world.h"
#include "runtime/result.h"

namespace penumbra::ecs {

// Limits of what is read, far beyond what a scene needs.
inline constexpr size_t kMaxSceneBytes = 64u << 20;
inline constexpr uint32_t kMaxSceneEntities = 1u << 20; // with those of prefabs
inline constexpr uint32_t kMaxPrefabParts = 1024;
inline constexpr uint32_t kMaxSceneDepth = 512; // parents above an entity
inline constexpr uint32_t kMaxJsonNesting = 64;
inline constexpr uint32_t kMaxJsonMembers = 1024; // of one object
inline constexpr int kSceneVersion = 1;

// How asset handles stand in files: by name. For the field's `kind` of asset.
class AssetNames {
public:
    static constexpr uint32_t kNoAsset = 0xffffffff; // null in files
    virtual ~AssetNames() = default;
    // May load it. Error: there is none of that name; the message says so and what to do.
    virtual Result<uint32_t> handleOf(const Field& field, const std::string& name) = 0;
    // Empty: there is no such handle.
    [[nodiscard]] virtual std::string nameOf(const Field& field, uint32_t handle) const = 0;
};

// Numbers names as they come and loads nothing: for tools and tests.
class AssetNameList : public AssetNames {
public:
    Result<uint32_t> handleOf(const Field& field, const std::string& name) override;
    [[nodiscard]] std::string nameOf(const Field& field, uint32_t handle) const override;

private:
    std::vector<std::string> m_names;
};

// What of files a world does not hold. Keep it beside the world from load to save.
struct Scene {
    struct NamedPrefab {
        std::string name;
        Prefab prefab;
        std::string json; // as in the file; empty: written from `prefab`
    };
    struct Kept { // JSON of a component or of one member that the program does not know
        Entity entity;
        std::string component, field; // field empty: the whole component
        std::string json;
    };
    struct Light { // an element of "lights", without its "entity"
        Entity entity;
        std::string json;
    };
    std::vector<NamedPrefab> prefabs;
    std::vector<Kept> kept;
    std::vector<Light> lights;
    std::vector<std::pair<std::string, std::string>> members; // unknown ones of the file itself

    [[nodiscard]] const NamedPrefab* find(std::string_view name) const; // null: none
};

struct LoadedScene {
    std::vector<Entity> entities; // by index in the file; of a prefab's instance, part 0
    std::vector<std::string> warnings;
};
// Adds the file's entities to the world and its prefabs and leftovers to the scene. `assets` null:
// a file with asset names is refused.
Result<LoadedScene> loadScene(World& world, Scene& scene, std::string_view text,
                              AssetNames* assets = nullptr);

struct SavedScene {
    std::string text;
    std::vector<std::string> warnings; // components without kFields are left out, and such
};
// All entities: by index, but parents and elder siblings first. Error: a value that could not be
// read again (not finite, out of range).
Result<SavedScene> saveScene(const World& world, const Scene& scene,
                             const AssetNames* assets = nullptr);

} // namespace penumbra::ecs
