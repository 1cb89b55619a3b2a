// Private to scene files: one call of loadScene(). Everything is read into prefabs first (the scene
// itself is one); only then is the world touched, in commit().
#pragma once

#include "runtime/ecs/field_json.h"
#include "runtime/ecs/world_access.h"

#include <fmt/format.h>
#include <map>

namespace penumbra::ecs {

// One "entities" list: of the scene, or of a prefab.
struct EntityList {
    Prefab prefab;
    std::vector<uint32_t> first;                        // [index in the file] its part
    std::vector<const Scene::NamedPrefab*> source;      // [index in the file] or null
    std::vector<std::pair<uint32_t, Scene::Kept>> kept; // by part
    std::vector<uint32_t> disabled;                     // parts
    bool isDefinition = false;
};

class SceneLoader {
public:
    SceneLoader(World& world, Scene& scene, AssetNames* assets)
        : m_world(world), m_scene(scene), m_access(world)
    {
        m_names.assets = assets;
        m_names.readEntity = [this](const Json& json, Entity& out) {
            return readReference(json, out);
        };
    }

    Result<LoadedScene> run(std::string_view text)
    {
        Result<Json> document = parseSceneJson(text);
        if (!document)
            return document.error();
        if (!read(*document))
            return Error{m_error};
        return commit();
    }

private:
    bool fail(const JsonPlace& place, const std::string& what)
    {
        const std::string text = place.text();
        m_error = fmt::format("{} {}", text.empty() ? "/" : text, what);
        return false;
    }
    void warn(const std::string& what, const JsonPlace& place)
    {
        auto [at, isNew] = m_warnings.try_emplace(what, std::pair(place.text(), 0u));
        ++at->second.second;
    }

    bool read(const Json& document);
    bool readPrefabs(const Json& list, const JsonPlace& place);
    bool readEntities(const Json& list, const JsonPlace& place, EntityList& out);
    bool layOut(const Json& entity, const JsonPlace& place, EntityList& out);
    bool readEntity(uint32_t index, const Json& entity, const JsonPlace& place, EntityList& out);
    bool readBody(uint32_t part, const Json& body, const JsonPlace& place, EntityList& out);
    bool readComponent(uint32_t part, const std::string& name, const Json& json,
                       const JsonPlace& place, EntityList& out);
    void keep(uint32_t part, const std::string& component, const std::string& field,
              const Json& json, EntityList& out)
    {
        out.kept.emplace_back(part, Scene::Kept{{}, component, field, json.dump()});
    }
    bool checkTree(const JsonPlace& place, const EntityList& list);
    bool readSingletons(const Json& list, const JsonPlace& place);
    bool readLights(const Json& list, const JsonPlace& place);
    std::string readReference(const Json& json, Entity& out);
    [[nodiscard]] const Scene::NamedPrefab* findPrefab(std::string_view name) const;
    // The part of an instance in the list; kNone: no such part, or removed.
    [[nodiscard]] static uint32_t findPart(const EntityList& list, uint32_t index,
                                           std::string_view key);
    LoadedScene commit();

    World& m_world;
    Scene& m_scene;
    WorldAccess m_access;
    FileNames m_names;
    std::string m_error;
    std::map<std::string, std::pair<std::string, uint32_t>> m_warnings; // first place, count
    std::vector<std::unique_ptr<Scene::NamedPrefab>> m_prefabs;
    EntityList m_entities;
    std::vector<std::pair<ComponentId, uint32_t>> m_singletons;
    std::vector<std::pair<uint32_t, std::string>> m_lights;
    std::vector<std::pair<std::string, std::string>> m_members;
    EntityList* m_list = nullptr; // that is being read
    uint32_t m_index = 0;         // in it
    uint32_t m_total = 0;         // parts of all lists
};

} // namespace penumbra::ecs
