// Private to scene files: one call of saveScene(). Put the entities in order, name them, then write
// them one by one; those of a prefab's instance as what differs from the prefab.
#pragma once

#include "runtime/ecs/field_json.h"
#include "runtime/ecs/world_access.h"

#include <map>
#include <set>

namespace penumbra::ecs {

class SceneSaver {
public:
    SceneSaver(const World& world, const Scene& scene, const AssetNames* assets)
        : m_world(world), m_scene(scene)
    {
        m_names.savedAssets = assets;
        m_names.entityJson = [this](Entity entity) { return referenceTo(entity); };
    }
    Result<SavedScene> run();

private:
    struct Instance {
        const Scene::NamedPrefab* source = nullptr;
        std::vector<Entity> parts; // [part], null: gone
    };
    using Components = std::map<std::pair<size_t, std::string>, Json>; // in the order of the file

    void findInstances();
    void orderEntities();
    Json referenceTo(Entity entity);
    Json entityJson(Entity entity);
    Json overridesJson(const Instance& instance);
    // Its Name where that is unique, else its number.
    [[nodiscard]] static std::string partKey(const Prefab& prefab, uint32_t part);
    Json bodyJson(Entity entity, const Instance* instance, uint32_t part);
    void addComponents(Entity entity, const Instance* instance, uint32_t part, Components& out);
    Json componentJson(Entity entity, ComponentId id, const std::byte* value,
                       const Instance* instance, uint32_t part);
    // The prefab's value with its parts as the instance's entities.
    [[nodiscard]] std::vector<std::byte> inherited(const Instance& instance, uint32_t part,
                                                   ComponentId id) const;
    Json prefabJson(const Scene::NamedPrefab& prefab);
    void addTail(Json& document);
    void warn(const std::string& text) { m_warnings.insert(text); }

    [[nodiscard]] const PrefabPart* linkOf(Entity entity) const
    {
        return m_world.tryGet<const PrefabPart>(entity);
    }
    // The instance that an entity is a part of; null: none.
    [[nodiscard]] const Instance* instanceOf(Entity entity) const
    {
        const PrefabPart* link = m_world.alive(entity) ? linkOf(entity) : nullptr;
        const auto found =
            link == nullptr ? m_instances.end() : m_instances.find(link->instance.index);
        return found == m_instances.end() ? nullptr : &found->second;
    }

    const World& m_world;
    const Scene& m_scene;
    FileNames m_names;
    std::map<uint32_t, Instance> m_instances; // by index of the first part
    std::vector<Entity> m_order;
    std::vector<uint32_t> m_fileIndex; // [entity index]; kNone: not in the list
    std::unordered_multimap<uint32_t, const Scene::Kept*> m_kept; // by entity index
    std::set<std::string> m_warnings;
    std::string m_error;
};

} // namespace penumbra::ecs
