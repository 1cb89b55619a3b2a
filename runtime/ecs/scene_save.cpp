// Saving of scene files: the order of entities, and each as JSON.
#include "runtime/ecs/name.h"
#include "runtime/ecs/reflection.h"
#include "runtime/ecs/scene_saver.h"

#include <algorithm>
#include <fmt/format.h>

namespace penumbra::ecs {

namespace {

// What people look for first; the rest goes by name.
constexpr std::string_view kFirstComponents[] = {"Name", "Parent", "Transform"};

size_t rank(std::string_view component)
{
    return static_cast<size_t>(
        std::find(std::begin(kFirstComponents), std::end(kFirstComponents), component) -
        std::begin(kFirstComponents));
}

} // namespace

Result<SavedScene> SceneSaver::run()
{
    for (const Scene::Kept& kept : m_scene.kept)
        if (m_world.alive(kept.entity))
            m_kept.emplace(kept.entity.index, &kept);
    findInstances();
    orderEntities();
    Json document = {{"version", kSceneVersion}};
    for (const Scene::NamedPrefab& prefab : m_scene.prefabs)
        document["prefabs"][prefab.name] = prefabJson(prefab);
    Json& list = document["entities"] = Json::array();
    for (const Entity entity : m_order)
        list.push_back(entityJson(entity));
    addTail(document);
    if (!m_error.empty())
        return Error{m_error};
    return SavedScene{document.dump(1, ' ', false, Json::error_handler_t::replace) + "\n",
                      {m_warnings.begin(), m_warnings.end()}};
}

// By index, but parents and elder siblings first, so that loading gives the same order of children.
void SceneSaver::orderEntities()
{
    const Hierarchy& links = WorldAccess::links(m_world);
    std::vector<Entity> all, elder(WorldAccess::indexCount(m_world));
    for (const auto& archetype : WorldAccess::archetypes(m_world))
        all.insert(all.end(), archetype->entities().begin(), archetype->entities().end());
    std::sort(all.begin(), all.end(), [](Entity a, Entity b) { return a.index < b.index; });
    for (const Entity parent : all) {
        Entity last;
        for (const Entity child :
             links.contains(parent) ? links.childrenOf(parent) : std::vector<Entity>{}) {
            elder[child.index] = last;
            last = child;
        }
    }
    const auto owner = [&](Entity entity) {
        const Instance* instance = instanceOf(entity);
        return instance == nullptr ? entity : instance->parts[0];
    };
    m_fileIndex.assign(elder.size(), kNone);
    std::vector<bool> seen(elder.size(), false);
    std::vector<Entity> stack;
    for (const Entity entity : all) {
        if (owner(entity) == entity)
            stack.push_back(entity);
        while (!stack.empty()) {
            const Entity top = stack.back();
            if (!seen[top.index]) {
                seen[top.index] = true;
                for (const Entity before : {elder[top.index], links.parentOf(top)})
                    if (!before.isNull() && !seen[owner(before).index])
                        stack.push_back(owner(before));
                continue;
            }
            stack.pop_back();
            if (m_fileIndex[top.index] == kNone) {
                m_fileIndex[top.index] = static_cast<uint32_t>(m_order.size());
                m_order.push_back(top);
            }
        }
    }
}

Json SceneSaver::referenceTo(Entity entity)
{
    if (!m_world.alive(entity)) {
        if (!entity.isNull())
            warn("a member names an entity that is gone; it is written as null");
        return nullptr;
    }
    const Instance* instance = instanceOf(entity);
    if (instance == nullptr || instance->parts[0] == entity)
        return m_fileIndex[entity.index];
    return {m_fileIndex[instance->parts[0].index],
            partKey(instance->source->prefab, linkOf(entity)->part)};
}

Json SceneSaver::componentJson(Entity entity, ComponentId id, const std::byte* value,
                               const Instance* instance, uint32_t part)
{
    const ComponentInfo& info = componentInfo(id);
    std::vector<std::byte> base;
    if (instance != nullptr && instance->source->prefab.components(part).test(id))
        base = inherited(*instance, part, id);
    Json json = Json::object();
    for (const Field& field : info.fields) {
        Result<Json> member = fieldToJson(field, value + field.offset, m_names);
        if (!member) {
            if (m_error.empty())
                m_error =
                    fmt::format("entity {}{}: {}.{} {}", toString(entity),
                                m_world.alive(entity) && m_world.has<Name>(entity)
                                    ? fmt::format(" '{}'", m_world.get<const Name>(entity).text())
                                    : "",
                                info.name, field.name, member.error().message);
            return json;
        }
        if (!base.empty()) {
            const Result<Json> before = fieldToJson(field, base.data() + field.offset, m_names);
            if (before && *before == *member)
                continue;
        }
        json[std::string(field.name)] = std::move(*member);
    }
    if (info.version > 1 && (!json.empty() || base.empty()))
        json["version"] = info.version;
    return json;
}

void SceneSaver::addComponents(Entity entity, const Instance* instance, uint32_t part,
                               Components& out)
{
    const ComponentMask mask = m_world.components(entity);
    const bool isPart = instance != nullptr && part > 0;
    mask.forEach([&](ComponentId id) {
        const ComponentInfo& info = componentInfo(id);
        if (info.transient || id == componentId<PrefabPart>() ||
            (isPart && id == componentId<Parent>()))
            return;
        if (!info.isPlain() || (info.bytes > 0 && info.fields.empty())) {
            warn(fmt::format("component {} does not describe its members (kFields) and is left out",
                             info.name));
            return;
        }
        const bool inheritedToo =
            instance != nullptr && instance->source->prefab.components(part).test(id);
        ComponentValue value(id);
        readComponent(m_world, entity, id, value.data());
        Json json = componentJson(entity, id, value.data(), instance, part);
        if (!json.empty() || !inheritedToo)
            out[{rank(info.name), std::string(info.name)}] = std::move(json);
    });
    if (instance != nullptr)
        (instance->source->prefab.components(part) - mask).forEach([&](ComponentId id) {
            const std::string name(componentInfo(id).name);
            out[{rank(name), name}] = nullptr;
        });
    const auto [first, last] = m_kept.equal_range(entity.index);
    std::vector<const Scene::Kept*> kept;
    for (auto it = first; it != last; ++it)
        kept.push_back(it->second);
    std::sort(kept.begin(), kept.end()); // as they were loaded
    for (const Scene::Kept* at : kept) {
        const std::pair key(rank(at->component), at->component);
        if (at->field.empty())
            out.try_emplace(key, Json::parse(at->json, nullptr, false));
        else if (const auto known = findComponent(at->component);
                 known != kNone && mask.test(static_cast<ComponentId>(known)))
            out.try_emplace(key, Json::object()).first->second[at->field] =
                Json::parse(at->json, nullptr, false);
    }
}

Json SceneSaver::bodyJson(Entity entity, const Instance* instance, uint32_t part)
{
    Components components;
    addComponents(entity, instance, part, components);
    Json json = Json::object();
    const Place at = WorldAccess::rowOf(m_world, entity);
    if (at.archetype->disabled().test(at.row))
        json["enabled"] = false;
    for (auto& [key, value] : components)
        json[key.second] = std::move(value);
    return json;
}

Json SceneSaver::entityJson(Entity entity)
{
    const Instance* instance = instanceOf(entity);
    if (instance == nullptr)
        return bodyJson(entity, nullptr, 0);
    Json json = {{"prefab", instance->source->name}};
    json.update(bodyJson(entity, instance, 0));
    if (Json overrides = overridesJson(*instance); !overrides.empty())
        json["overrides"] = std::move(overrides);
    return json;
}

Json SceneSaver::prefabJson(const Scene::NamedPrefab& prefab)
{
    if (!prefab.json.empty())
        return Json::parse(prefab.json, nullptr, false);
    const auto worldNames = m_names.entityJson;
    m_names.entityJson = [](Entity entity) {
        return entity.isDeferred() ? Json(entity.index) : Json(nullptr);
    };
    Json list = Json::array();
    for (uint32_t i = 0; i < prefab.prefab.partCount(); ++i) {
        Components components;
        prefab.prefab.components(i).forEach([&](ComponentId id) {
            const ComponentInfo& info = componentInfo(id);
            if (info.transient || id == componentId<PrefabPart>())
                return;
            if (info.bytes > 0 && info.fields.empty()) {
                warn(fmt::format(
                    "component {} does not describe its members (kFields) and is left out",
                    info.name));
                return;
            }
            components[{rank(info.name), std::string(info.name)}] =
                componentJson({}, id, prefab.prefab.find(i, id), nullptr, 0);
        });
        Json& part = list.emplace_back(Json::object());
        for (auto& [key, value] : components)
            part[key.second] = std::move(value);
    }
    m_names.entityJson = worldNames;
    return {{"entities", std::move(list)}};
}

void SceneSaver::addTail(Json& document)
{
    const std::vector<Entity>& singletons = WorldAccess::singletons(m_world);
    std::map<std::string, Json> named;
    for (uint32_t id = 0; id < singletons.size(); ++id)
        if (const Entity entity = singletons[id];
            m_world.alive(entity) && m_fileIndex[entity.index] != kNone) {
            const ComponentInfo& info = componentInfo(static_cast<ComponentId>(id));
            if (info.isPlain() && (info.bytes == 0 || !info.fields.empty()))
                named[std::string(info.name)] = m_fileIndex[entity.index];
        }
    for (auto& [name, json] : named)
        document["singletons"][name] = std::move(json);
    for (const Scene::Light& light : m_scene.lights) {
        if (!m_world.alive(light.entity) || m_fileIndex[light.entity.index] == kNone)
            continue; // it went with its entity
        Json json = {{"entity", m_fileIndex[light.entity.index]}};
        json.update(Json::parse(light.json, nullptr, false));
        document["lights"].push_back(std::move(json));
    }
    for (const auto& [key, value] : m_scene.members)
        document[key] = Json::parse(value, nullptr, false);
}

const Scene::NamedPrefab* Scene::find(std::string_view name) const
{
    for (const NamedPrefab& prefab : prefabs)
        if (prefab.name == name)
            return &prefab;
    return nullptr;
}

Result<uint32_t> AssetNameList::handleOf(const Field&, const std::string& name)
{
    const auto found = std::find(m_names.begin(), m_names.end(), name);
    const auto handle = static_cast<uint32_t>(found - m_names.begin());
    if (found == m_names.end())
        m_names.push_back(name);
    return handle;
}

std::string AssetNameList::nameOf(const Field&, uint32_t handle) const
{
    return handle < m_names.size() ? m_names[handle] : "";
}

Result<SavedScene> saveScene(const World& world, const Scene& scene, const AssetNames* assets)
{
    return SceneSaver(world, scene, assets).run();
}

} // namespace penumbra::ecs
