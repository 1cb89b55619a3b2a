// Loading of scene files: the document, its prefabs, and what becomes of it.
#include "runtime/ecs/name.h"
#include "runtime/ecs/scene_loader.h"

#include <fmt/format.h>

namespace penumbra::ecs {

bool SceneLoader::read(const Json& document)
{
    const JsonPlace root;
    if (!document.is_object())
        return fail(root, "is no object; a scene is {\"version\": 1, \"entities\": […]}");
    const auto version = document.find("version");
    if (version == document.end() || !version->is_number_unsigned())
        return fail(root / "version", "is missing, or no whole number; write 1");
    if (version->get<uint64_t>() != kSceneVersion)
        return fail(root / "version",
                    fmt::format("is {}, but this program reads {}; use a newer program, or save "
                                "the scene for this one",
                                version->get<uint64_t>(), kSceneVersion));
    if (!document.contains("entities"))
        return fail(root / "entities", "is missing; write a list, which may be empty");
    if (document.contains("prefabs") && !readPrefabs(document["prefabs"], root / "prefabs"))
        return false;
    if (!readEntities(document["entities"], root / "entities", m_entities))
        return false;
    for (const auto& [key, value] : document.items()) {
        const JsonPlace place = root / key;
        if (key == "singletons") {
            if (!readSingletons(value, place))
                return false;
        } else if (key == "lights") {
            if (!readLights(value, place))
                return false;
        } else if (key != "version" && key != "entities" && key != "prefabs") {
            m_members.emplace_back(key, value.dump());
            warn("is unknown to this program and was kept as it is", place);
        }
    }
    return true;
}

bool SceneLoader::readPrefabs(const Json& list, const JsonPlace& place)
{
    if (!list.is_object())
        return fail(place, "is no object; write {\"name\": {\"entities\": […]}}");
    for (const auto& [name, json] : list.items()) {
        const JsonPlace here = place / name;
        if (findPrefab(name) != nullptr)
            return fail(here, "is a prefab that there is already; give it another name");
        if (name.empty() || !json.is_object() || !json.contains("entities"))
            return fail(here, "has no name or no \"entities\"; write both");
        EntityList entities;
        entities.isDefinition = true;
        if (!readEntities(json["entities"], here / "entities", entities))
            return false;
        if (entities.prefab.partCount() == 0)
            return fail(here, "is an empty prefab; give it an entity");
        if (entities.prefab.partCount() > kMaxPrefabParts)
            return fail(here, fmt::format("has more than {} entities; split it", kMaxPrefabParts));
        for (uint32_t i = 0; i < entities.prefab.partCount(); ++i)
            if ((entities.prefab.parentOf(i) == kNone) != (i == 0))
                return fail(here / "entities",
                            "has not one root, its first entity; put a Parent on all others only");
        m_prefabs.push_back(std::make_unique<Scene::NamedPrefab>(
            Scene::NamedPrefab{name, std::move(entities.prefab), json.dump()}));
    }
    return true;
}

bool SceneLoader::readSingletons(const Json& list, const JsonPlace& place)
{
    if (!list.is_object())
        return fail(place, "is no object; write {\"Component\": entity}");
    for (const auto& [name, json] : list.items()) {
        const uint32_t known = findComponent(name);
        const auto id = static_cast<ComponentId>(known);
        const uint64_t index = json.is_number_unsigned() ? json.get<uint64_t>() : ~uint64_t{0};
        if (index >= m_entities.first.size())
            return fail(place / name, fmt::format("is not the index of one of {} entities",
                                                  m_entities.first.size()));
        const uint32_t part = m_entities.first[index];
        if (known == kNone) {
            warn(fmt::format("singleton {} is unknown to this program and was dropped", name),
                 place / name);
            continue;
        }
        if (!m_entities.prefab.components(part).test(id))
            return fail(place / name,
                        fmt::format("is entity {}, which has no such component; add it", index));
        const std::vector<Entity>& there = WorldAccess::singletons(m_world);
        if (id < there.size() && m_world.alive(there[id]))
            return fail(place / name, "is a singleton that the world has already; destroy that, "
                                      "or take this one out");
        m_singletons.emplace_back(id, part);
    }
    return true;
}

bool SceneLoader::readLights(const Json& list, const JsonPlace& place)
{
    if (!list.is_array())
        return fail(place, "is no list; write […]");
    for (size_t i = 0; i < list.size(); ++i) {
        Json light = list[i];
        const auto entity = light.is_object() ? light.find("entity") : light.end();
        if (entity == light.end() || !entity->is_number_unsigned() ||
            entity->get<uint64_t>() >= m_entities.first.size())
            return fail(
                place.at(i) / "entity",
                fmt::format("is not the index of one of {} entities", m_entities.first.size()));
        const uint32_t part = m_entities.first[entity->get<uint64_t>()];
        light.erase("entity");
        m_lights.emplace_back(part, light.dump());
    }
    return true;
}

const Scene::NamedPrefab* SceneLoader::findPrefab(std::string_view name) const
{
    for (const auto& prefab : m_prefabs)
        if (prefab->name == name)
            return prefab.get();
    return m_scene.find(name);
}

LoadedScene SceneLoader::commit()
{
    LoadedScene out;
    const std::vector<Entity> made = instantiateUntold(m_world, m_entities.prefab);
    for (const uint32_t part : m_entities.first)
        out.entities.push_back(made[part]);
    for (const uint32_t part : m_entities.disabled) {
        const Place at = WorldAccess::rowOf(m_world, made[part]);
        at.archetype->setDisabled(at.row, true, m_access.stamp());
    }
    for (const auto& [id, part] : m_singletons)
        m_access.setSingleton(id, made[part]);
    m_access.tellCreated(made);
    for (auto& prefab : m_prefabs)
        m_scene.prefabs.push_back(std::move(*prefab));
    for (auto& [part, kept] : m_entities.kept) {
        kept.entity = made[part];
        m_scene.kept.push_back(std::move(kept));
    }
    for (auto& [part, json] : m_lights)
        m_scene.lights.push_back({made[part], std::move(json)});
    for (auto& member : m_members)
        m_scene.members.push_back(std::move(member));
    for (const auto& [what, where] : m_warnings)
        out.warnings.push_back(
            where.second == 1 ? fmt::format("{}: {}", where.first, what)
                              : fmt::format("{}: {} ({} times)", where.first, what, where.second));
    return out;
}

Result<LoadedScene> loadScene(World& world, Scene& scene, std::string_view text, AssetNames* assets)
{
    registerComponents<Name, Parent, PrefabPart>();
    return SceneLoader(world, scene, assets).run(text);
}

} // namespace penumbra::ecs
