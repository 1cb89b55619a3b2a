// Loading of scene files: a list of entities.
#include "runtime/ecs/reflection.h"
#include "runtime/ecs/scene_loader.h"

#include <algorithm>
#include <fmt/format.h>

namespace penumbra::ecs {

bool SceneLoader::readEntities(const Json& list, const JsonPlace& place, EntityList& out)
{
    if (!list.is_array())
        return fail(place, "is no list; write […]");
    for (size_t i = 0; i < list.size(); ++i) // parts first: entities may name later ones
        if (!layOut(list[i], place.at(i), out))
            return false;
    m_list = &out;
    for (size_t i = 0; i < list.size(); ++i)
        if (!readEntity(static_cast<uint32_t>(i), list[i], place.at(i), out))
            return false;
    return checkTree(place, out);
}

bool SceneLoader::layOut(const Json& entity, const JsonPlace& place, EntityList& out)
{
    if (!entity.is_object())
        return fail(place, "is no object; an entity is {\"Component\": {…}, …}");
    const Scene::NamedPrefab* source = nullptr;
    Prefab copy;
    if (const auto name = entity.find("prefab"); name != entity.end()) {
        source = name->is_string() ? findPrefab(name->get<std::string>()) : nullptr;
        if (source == nullptr)
            return fail(place / "prefab", "is no prefab's name; define it in \"prefabs\", above "
                                          "the prefabs that use it");
        if (m_total + source->prefab.partCount() > kMaxSceneEntities)
            return fail(place, fmt::format("makes more than {} entities; split the scene",
                                           kMaxSceneEntities));
        copy = source->prefab;
        copy.link(source->name);
    } else {
        copy.addPart();
    }
    if (const auto overrides = entity.find("overrides"); overrides != entity.end()) {
        const JsonPlace here = place / "overrides";
        if (source == nullptr || !overrides->is_object())
            return fail(here, "is no object beside \"prefab\"; write {\"part\": {…}}");
        std::vector<uint32_t> removed;
        for (const auto& [key, value] : overrides->items()) {
            const uint32_t part = source->prefab.findPart(key);
            if (part == kNone)
                return fail(here / key, "is no part's number, nor the Name of just one part");
            if (value.is_null() && part == 0)
                return fail(here / key, "removes the root; remove the entity instead");
            if (value.is_null())
                removed.push_back(part);
        }
        std::sort(removed.begin(), removed.end(), std::greater<>()); // children before parents
        for (const uint32_t part : removed)
            for (uint32_t i = 0; i < copy.partCount(); ++i) {
                PrefabPart link;
                std::memcpy(&link, copy.find(i, componentId<PrefabPart>()), sizeof(link));
                if (link.part == part) {
                    copy.removePart(i);
                    break;
                }
            }
    }
    m_total += copy.partCount();
    if (m_total > kMaxSceneEntities)
        return fail(place,
                    fmt::format("is one entity more than {}; split the scene", kMaxSceneEntities));
    out.first.push_back(out.prefab.append(copy));
    out.source.push_back(source);
    return true;
}

bool SceneLoader::readEntity(uint32_t index, const Json& entity, const JsonPlace& place,
                             EntityList& out)
{
    m_index = index;
    if (!readBody(out.first[index], entity, place, out))
        return false;
    const auto overrides = entity.find("overrides");
    if (overrides == entity.end())
        return true;
    const JsonPlace here = place / "overrides";
    for (const auto& [key, body] : overrides->items()) {
        if (body.is_null())
            continue;
        const uint32_t part = findPart(out, index, key);
        if (part == kNone)
            return fail(here / key, "is below a part that is removed; take one of the two out");
        if (!body.is_object())
            return fail(here / key, "is no object; write {\"Component\": {…}}, or null");
        if (!readBody(part, body, here / key, out))
            return false;
    }
    return true;
}

bool SceneLoader::readBody(uint32_t part, const Json& body, const JsonPlace& place, EntityList& out)
{
    for (const auto& [name, json] : body.items()) {
        const JsonPlace here = place / name;
        if (name == "prefab" || name == "overrides")
            continue;
        if (name == "enabled") {
            if (!json.is_boolean())
                return fail(here, "is neither true nor false; write one of them");
            if (out.isDefinition)
                return fail(here, "is not for prefabs; write it on their instances");
            if (!json.get<bool>())
                out.disabled.push_back(part);
        } else if (!readComponent(part, name, json, here, out)) {
            return false;
        }
    }
    return true;
}

bool SceneLoader::readComponent(uint32_t part, const std::string& name, const Json& json,
                                const JsonPlace& place, EntityList& out)
{
    const uint32_t known = findComponent(name);
    const auto id = static_cast<ComponentId>(known);
    if (known == componentId<PrefabPart>())
        return fail(place, "is not written by hand; write \"prefab\": \"name\"");
    if (json.is_null() && known != kNone && out.prefab.components(part).test(id)) {
        out.prefab.removeById(part, id); // of a prefab's instance
        return true;
    }
    if (known == kNone || (componentInfo(id).bytes > 0 && componentInfo(id).fields.empty()) ||
        !componentInfo(id).isPlain()) {
        keep(part, name, "", json, out);
        warn(fmt::format("component {} is unknown to this program and was kept as it is", name),
             place);
        return true;
    }
    const ComponentInfo& info = componentInfo(id);
    if (!json.is_object())
        return fail(place, "is no object; write {\"member\": value, …}");
    if (const auto version = json.find("version"); version != json.end()) {
        if (!version->is_number_unsigned())
            return fail(place / "version", "is no whole number; write one");
        if (version->get<uint64_t>() > info.version) {
            keep(part, name, "", json, out);
            warn(fmt::format("component {} has version {}, newer than this program's {}, and was "
                             "kept as it is",
                             name, version->get<uint64_t>(), info.version),
                 place);
            return true;
        }
    }
    ComponentValue value(id);
    if (const std::byte* inherited = out.prefab.find(part, id))
        std::memcpy(value.data(), inherited, info.bytes);
    for (const auto& [key, member] : json.items()) {
        const Field* field = findField(id, key);
        if (field == nullptr && key == "version")
            continue;
        if (field == nullptr) {
            keep(part, name, key, member, out);
            warn(fmt::format("member {}.{} is unknown to this program and was kept as it is", name,
                             key),
                 place);
            continue;
        }
        std::string warning;
        const Result<void> read =
            fieldFromJson(*field, member, value.member(*field), m_names, warning);
        if (!read)
            return fail(place / key, read.error().message);
        if (!warning.empty())
            warn(fmt::format("{}.{} {}", name, key, warning), place / key);
    }
    if (id == componentId<Parent>()) {
        Parent parent;
        std::memcpy(&parent, value.data(), sizeof(parent));
        const uint32_t first = out.first[m_index];
        const bool inside =
            part > first && parent.entity.index >= first && parent.entity.index < part;
        if (!parent.entity.isDeferred() || (parent.entity.index >= first && !inside))
            return fail(place / "entity",
                        fmt::format("is not the index of an entity before this one ({}); put "
                                    "parents before their children",
                                    m_index));
    }
    out.prefab.setById(part, id, value.data());
    return true;
}

// Parents before children, so no cycles; and not too deep.
bool SceneLoader::checkTree(const JsonPlace& place, const EntityList& list)
{
    std::vector<uint32_t> depth(list.prefab.partCount(), 0);
    for (uint32_t i = 0; i < depth.size(); ++i) {
        const uint32_t parent = list.prefab.parentOf(i);
        if (parent == kNone)
            continue;
        if (parent >= i)
            return fail(place, "has a prefab with a part before its parent; reorder its parts");
        depth[i] = depth[parent] + 1;
        if (depth[i] > kMaxSceneDepth)
            return fail(place, fmt::format("has an entity with more than {} above it; flatten it",
                                           kMaxSceneDepth));
    }
    return true;
}

std::string SceneLoader::readReference(const Json& json, Entity& out)
{
    out = {};
    if (json.is_null())
        return {};
    const bool toPart = json.is_array() && json.size() == 2 && json[1].is_string();
    const Json& number = toPart ? json[0] : json;
    const uint64_t index = number.is_number_unsigned() ? number.get<uint64_t>() : ~uint64_t{0};
    if (index >= m_list->first.size())
        return fmt::format("is not the index of one of {} entities; write an index, null, or "
                           "[index of a prefab's instance, \"part\"]",
                           m_list->first.size());
    out = Prefab::part(m_list->first[index]);
    if (!toPart)
        return {};
    const uint32_t part =
        findPart(*m_list, static_cast<uint32_t>(index), json[1].get<std::string>());
    out = Prefab::part(part);
    return part == kNone ? "is no part of that instance; write its number or Name" : "";
}

uint32_t SceneLoader::findPart(const EntityList& list, uint32_t index, std::string_view key)
{
    if (list.source[index] == nullptr)
        return kNone;
    const uint32_t number = list.source[index]->prefab.findPart(key);
    const uint32_t end =
        index + 1 < list.first.size() ? list.first[index + 1] : list.prefab.partCount();
    for (uint32_t i = list.first[index]; number != kNone && i < end; ++i) {
        PrefabPart link;
        std::memcpy(&link, list.prefab.find(i, componentId<PrefabPart>()), sizeof(link));
        if (link.part == number)
            return i;
    }
    return kNone;
}

} // namespace penumbra::ecs
