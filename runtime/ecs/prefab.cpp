#include "runtime/ecs/prefab.h"

#include "runtime/assert.h"
#include "runtime/ecs/name.h"
#include "runtime/ecs/reflection.h"
#include "runtime/ecs/world_access.h"

#include <algorithm>
#include <charconv>
#include <unordered_map>

namespace penumbra::ecs {

template <class F>
void Prefab::changeEntities(Part& part, F&& f)
{
    for (const Value& value : part.values)
        for (const uint32_t field : componentInfo(value.id).entityFields) {
            Entity entity;
            std::memcpy(&entity, m_bytes.data() + value.offset + field, sizeof(entity));
            f(entity);
            std::memcpy(m_bytes.data() + value.offset + field, &entity, sizeof(entity));
        }
}

uint32_t Prefab::addPart(uint32_t parent)
{
    const uint32_t index = partCount();
    m_parts.emplace_back();
    if (parent != kNone)
        set(index, Parent{part(parent)});
    return index;
}

uint32_t Prefab::append(const Prefab& other, uint32_t parent)
{
    PENUMBRA_ASSERT(&other != this, "a prefab cannot contain itself");
    const uint32_t first = partCount();
    const auto bytes = static_cast<uint32_t>(m_bytes.size());
    m_bytes.insert(m_bytes.end(), other.m_bytes.begin(), other.m_bytes.end());
    for (const Part& source : other.m_parts) {
        Part& added = m_parts.emplace_back(source);
        for (Value& value : added.values)
            value.offset += bytes;
        changeEntities(added, [&](Entity& entity) {
            if (entity.isDeferred())
                entity.index += first;
        });
    }
    if (parent != kNone)
        for (uint32_t i = first; i < partCount(); ++i)
            if (find(i, componentId<Parent>()) == nullptr)
                set(i, Parent{part(parent)});
    return first;
}

void Prefab::removePart(uint32_t part)
{
    std::vector<uint32_t> newIndex(partCount(), 0);
    newIndex[part] = kNone;
    for (bool grows = true; grows;) { // parents may come after their children
        grows = false;
        for (uint32_t i = 0; i < partCount(); ++i)
            if (const uint32_t parent = parentOf(i);
                newIndex[i] != kNone && parent != kNone && newIndex[parent] == kNone) {
                newIndex[i] = kNone;
                grows = true;
            }
    }
    uint32_t kept = 0;
    for (uint32_t i = 0; i < newIndex.size(); ++i)
        if (newIndex[i] != kNone) {
            newIndex[i] = kept;
            if (i != kept)
                m_parts[kept] = std::move(m_parts[i]);
            ++kept;
        }
    m_parts.resize(kept);
    for (Part& left : m_parts)
        changeEntities(left, [&](Entity& entity) {
            if (entity.isDeferred())
                entity = newIndex[entity.index] == kNone ? Entity{}
                                                         : Prefab::part(newIndex[entity.index]);
        });
}

void Prefab::setById(uint32_t part, ComponentId id, const void* value)
{
    const ComponentInfo& info = componentInfo(id);
    PENUMBRA_ASSERT(part < partCount(), "part {} of {}", part, partCount());
    PENUMBRA_ASSERT(info.isPlain(), "'{}' is not trivially copyable: prefabs cannot hold it",
                    info.name);
    Part& target = m_parts[part];
    target.mask.set(id);
    if (info.bytes == 0)
        return;
    const auto known = std::find_if(target.values.begin(), target.values.end(),
                                    [&](const Value& v) { return v.id == id; });
    const uint32_t offset =
        known != target.values.end() ? known->offset : static_cast<uint32_t>(m_bytes.size());
    if (known == target.values.end()) {
        m_bytes.resize(m_bytes.size() + info.bytes);
        target.values.push_back({id, offset});
    }
    if (value == nullptr)
        std::memcpy(m_bytes.data() + offset, ComponentValue(id).data(), info.bytes);
    else
        std::memcpy(m_bytes.data() + offset, value, info.bytes);
}

void Prefab::removeById(uint32_t part, ComponentId id)
{
    m_parts[part].mask.reset(id);
    std::erase_if(m_parts[part].values, [&](const Value& value) { return value.id == id; });
}

const std::byte* Prefab::find(uint32_t part, ComponentId id) const
{
    for (const Value& value : m_parts[part].values)
        if (value.id == id)
            return m_bytes.data() + value.offset;
    return nullptr;
}

uint32_t Prefab::parentOf(uint32_t part) const
{
    const std::byte* value = find(part, componentId<Parent>());
    Parent parent;
    if (value != nullptr)
        std::memcpy(&parent, value, sizeof(parent));
    return parent.entity.isDeferred() ? parent.entity.index : kNone;
}

uint32_t Prefab::findPart(std::string_view key) const
{
    uint32_t number = kNone;
    const char* end = key.data() + key.size();
    if (const auto read = std::from_chars(key.data(), end, number);
        read.ec == std::errc{} && read.ptr == end)
        return number < partCount() ? number : kNone;
    uint32_t found = kNone;
    for (uint32_t i = 0; i < partCount(); ++i)
        if (const std::byte* value = find(i, componentId<Name>())) {
            Name name;
            std::memcpy(&name, value, sizeof(name));
            if (name.text() != key)
                continue;
            if (found != kNone)
                return kNone;
            found = i;
        }
    return found;
}

void Prefab::link(std::string_view name)
{
    for (uint32_t i = 0; i < partCount(); ++i)
        set(i, PrefabPart{part(0), hashName(name), i});
}

Prefab capturePrefab(const World& world, Entity root)
{
    std::vector<Entity> entities;
    static_cast<void>(WorldAccess::rowOf(world, root)); // asserts that it lives
    WorldAccess::collect(world, root, entities);
    std::unordered_map<uint32_t, uint32_t> partOf; // by entity index
    for (uint32_t i = 0; i < entities.size(); ++i)
        partOf.emplace(entities[i].index, i);
    Prefab prefab;
    for (uint32_t i = 0; i < entities.size(); ++i) {
        prefab.addPart();
        world.components(entities[i]).forEach([&](ComponentId id) {
            const ComponentInfo& info = componentInfo(id);
            if (!info.isPlain() || id == componentId<PrefabPart>() ||
                (i == 0 && id == componentId<Parent>()))
                return;
            ComponentValue value(id);
            readComponent(world, entities[i], id, value.data());
            for (const uint32_t field : info.entityFields) {
                Entity entity;
                std::memcpy(&entity, value.data() + field, sizeof(entity));
                if (world.alive(entity) && partOf.contains(entity.index))
                    entity = Prefab::part(partOf.at(entity.index));
                std::memcpy(value.data() + field, &entity, sizeof(entity));
            }
            prefab.setById(i, id, value.data());
        });
    }
    return prefab;
}

} // namespace penumbra::ecs
