// Saving of scene files: which entities are instances of prefabs, and how they differ.
#include "runtime/ecs/name.h"
#include "runtime/ecs/reflection.h"
#include "runtime/ecs/scene_saver.h"

#include <algorithm>
#include <fmt/format.h>

namespace penumbra::ecs {

std::string SceneSaver::partKey(const Prefab& prefab, uint32_t part)
{
    if (const std::byte* value = prefab.find(part, componentId<Name>())) {
        Name name;
        std::memcpy(&name, value, sizeof(name));
        if (!name.text().empty() && isUtf8(name.text()) && prefab.findPart(name.text()) == part)
            return std::string(name.text());
    }
    return std::to_string(part);
}

void SceneSaver::findInstances()
{
    std::set<uint32_t> broken; // by index of the first part
    for (const auto& archetype : WorldAccess::archetypes(m_world))
        for (const Entity entity : archetype->entities()) {
            const PrefabPart* link = linkOf(entity);
            if (link == nullptr)
                break; // nor has any other of the archetype
            const auto source =
                std::find_if(m_scene.prefabs.begin(), m_scene.prefabs.end(),
                             [&](const auto& p) { return hashName(p.name) == link->prefabHash; });
            if (source == m_scene.prefabs.end() || !m_world.alive(link->instance) ||
                link->part >= source->prefab.partCount()) {
                broken.insert(link->instance.index);
                continue;
            }
            Instance& instance = m_instances[link->instance.index];
            if (instance.source == nullptr)
                instance = {&*source, std::vector<Entity>(source->prefab.partCount())};
            const bool fits = instance.source == &*source && instance.parts[link->part].isNull() &&
                              (link->part == 0) == (entity == link->instance);
            if (fits)
                instance.parts[link->part] = entity;
            else
                broken.insert(link->instance.index);
        }
    // Written as differences only if every part still hangs where the prefab has it.
    const Hierarchy& links = WorldAccess::links(m_world);
    for (const auto& [index, instance] : m_instances) {
        bool whole = !instance.parts[0].isNull();
        for (uint32_t i = 1; whole && i < instance.parts.size(); ++i) {
            const uint32_t parent = instance.source->prefab.parentOf(i);
            if (instance.parts[i].isNull())
                continue;
            whole = parent < i && links.parentOf(instance.parts[i]) == instance.parts[parent];
        }
        if (!whole)
            broken.insert(index);
    }
    for (const uint32_t index : broken) {
        const auto found = m_instances.find(index);
        if (found == m_instances.end())
            continue;
        warn(fmt::format("an instance of prefab '{}' was taken apart; it is written as entities "
                         "of their own",
                         found->second.source->name));
        m_instances.erase(found);
    }
}

std::vector<std::byte> SceneSaver::inherited(const Instance& instance, uint32_t part,
                                             ComponentId id) const
{
    const ComponentInfo& info = componentInfo(id);
    std::vector<std::byte> value(info.bytes);
    if (info.bytes == 0)
        return value;
    std::memcpy(value.data(), instance.source->prefab.find(part, id), info.bytes);
    for (const uint32_t field : info.entityFields) {
        Entity entity;
        std::memcpy(&entity, value.data() + field, sizeof(entity));
        if (entity.isDeferred())
            entity = instance.parts[entity.index];
        std::memcpy(value.data() + field, &entity, sizeof(entity));
    }
    return value;
}

Json SceneSaver::overridesJson(const Instance& instance)
{
    const Prefab& prefab = instance.source->prefab;
    Json overrides = Json::object();
    for (uint32_t i = 1; i < instance.parts.size(); ++i) {
        if (instance.parts[i].isNull()) {
            if (!instance.parts[prefab.parentOf(i)].isNull()) // else it went with its parent
                overrides[partKey(prefab, i)] = nullptr;
        } else if (Json body = bodyJson(instance.parts[i], &instance, i); !body.empty()) {
            overrides[partKey(prefab, i)] = std::move(body);
        }
    }
    return overrides;
}

} // namespace penumbra::ecs
