// Reading of snapshots: components, entities, hierarchy, singletons; then the world takes it all.
#include "runtime/ecs/name.h"
#include "runtime/ecs/prefab.h"
#include "runtime/ecs/snapshot.h"
#include "runtime/ecs/snapshot_format.h"
#include "runtime/ecs/snapshot_reader.h"

#include <cstring>

namespace penumbra::ecs {

std::string SnapshotReader::run()
{
    if (readHead() && readComponents() && readEntities() && readArchetypes() && readHierarchy() &&
        readSingletons() && !m_bytes.empty())
        refuse("bytes after its end");
    return m_error;
}

bool SnapshotReader::readHead()
{
    constexpr size_t kLeast = sizeof(kSnapshotMagic) + 2 * sizeof(uint16_t) + sizeof(uint64_t);
    if (m_bytes.size() < kLeast ||
        std::memcmp(m_bytes.data(), kSnapshotMagic, sizeof(kSnapshotMagic)) != 0)
        return refuseWith("no snapshot of a world; it would begin with PWLD");
    uint16_t major = 0;
    std::memcpy(&major, m_bytes.data() + sizeof(kSnapshotMagic), sizeof(major));
    if (major != kSnapshotMajor)
        return refuseWith(fmt::format("a snapshot of version {}, but this program reads {}; "
                                      "take it again with this program",
                                      major, kSnapshotMajor));
    uint64_t sum = 0;
    std::memcpy(&sum, m_bytes.data() + m_bytes.size() - sizeof(sum), sizeof(sum));
    m_bytes = m_bytes.first(m_bytes.size() - sizeof(sum));
    if (sum != snapshotChecksum(m_bytes))
        return refuse("its checksum is wrong");
    take(sizeof(kSnapshotMagic) + 2 * sizeof(uint16_t));
    return true;
}

bool SnapshotReader::readComponents()
{
    const uint32_t count = getCount(sizeof(uint16_t));
    for (uint32_t i = 0; i < count && ok(); ++i) {
        const auto text = take(get<uint16_t>());
        const std::string name(reinterpret_cast<const char*>(text.data()), text.size());
        const auto bytes = get<uint32_t>();
        const auto lanes = get<uint32_t>();
        const auto layout = get<uint64_t>();
        const bool hooked = get<uint8_t>() != 0;
        if (!ok())
            break;
        const uint32_t id = findComponent(name);
        if (id == kNone)
            return refuseWith(fmt::format("component {} is unknown to this program; call "
                                          "registerComponents<{}>() before",
                                          name, name));
        const ComponentInfo& info = componentInfo(static_cast<ComponentId>(id));
        if (info.bytes != bytes || info.laneCount != lanes || layoutHash(info) != layout ||
            (info.save != nullptr) != hooked)
            return refuseWith(fmt::format("component {} has another layout in this program ({} "
                                          "bytes, {} in the snapshot); take it again",
                                          name, info.bytes, bytes));
        if (m_known.test(static_cast<ComponentId>(id)))
            return refuse("a component twice");
        m_known.set(static_cast<ComponentId>(id));
        m_components.push_back(static_cast<ComponentId>(id));
    }
    return ok();
}

bool SnapshotReader::readEntities()
{
    auto& records = contents.records;
    constexpr uint32_t kMaxIndices = 1u << 30; // what EntityTable finds places for
    const uint32_t count = getCount(sizeof(uint32_t));
    if (count > kMaxIndices)
        return refuse(fmt::format("{} entities", count));
    records.resize(count);
    for (auto& record : records) {
        record.generation = get<uint32_t>();
        if (record.generation == 0 || record.generation > 1u << 31)
            return refuse("a generation out of range");
    }
    contents.free.resize(getCount(sizeof(uint32_t)));
    m_isFree.resize(records.size());
    for (uint32_t& index : contents.free) {
        index = get<uint32_t>();
        if (index >= records.size() || m_isFree[index] || records[index].generation >= 1u << 31)
            return refuse("a free index that cannot be");
        m_isFree[index] = true;
    }
    return ok();
}

Entity SnapshotReader::living(uint32_t index)
{
    const auto& records = contents.records;
    if (index >= records.size() || records[index].archetype == kNone)
        return {};
    return {index, records[index].generation};
}

Entity SnapshotReader::parentValue(Entity entity)
{
    const auto& record = contents.records[entity.index];
    const Archetype& archetype = *contents.archetypes[record.archetype];
    Parent parent;
    if (archetype.mask().test(componentId<Parent>()))
        archetype.read(componentId<Parent>(), record.row, &parent);
    return parent.entity;
}

// Must agree with the Parent components, level by level: then there is no cycle.
bool SnapshotReader::readHierarchy()
{
    const uint32_t count = getCount(2 * sizeof(uint32_t));
    std::vector<Entity> order;
    std::vector<bool> hasChild(count), seen(contents.records.size());
    uint32_t last = 0, children = 0;
    for (uint32_t i = 0; i < count; ++i) {
        const Entity entity = living(get<uint32_t>());
        const auto parentSlot = get<uint32_t>();
        const uint32_t slot = parentSlot + 1; // 0: a root; roots first, then by parent
        if (entity.isNull() || seen[entity.index] || slot > i || slot < last)
            return refuse("a hierarchy that cannot be");
        const Entity parent = slot == 0 ? Entity{} : order[parentSlot];
        if (parentValue(entity) != parent)
            return refuse("a Parent that is not the hierarchy's");
        if (slot > 0)
            hasChild[parentSlot] = true;
        children += slot > 0;
        last = slot;
        seen[entity.index] = true;
        order.push_back(entity);
        contents.link(entity, parent);
    }
    uint32_t withParent = 0;
    for (const auto& archetype : contents.archetypes)
        if (archetype->mask().test(componentId<Parent>()))
            withParent += archetype->count();
    if (!ok() || withParent != children)
        return refuse("a Parent without a place in the hierarchy");
    for (uint32_t i = 0; i < count && parentValue(order[i]).isNull(); ++i)
        if (!hasChild[i])
            return refuse("a root without children");
    return true;
}

bool SnapshotReader::readSingletons()
{
    const uint32_t count = getCount(sizeof(uint16_t) + 2 * sizeof(uint32_t));
    for (uint32_t i = 0; i < count; ++i) {
        const auto component = get<uint16_t>();
        const Entity entity = living(get<uint32_t>());
        if (entity.isNull() || entity.generation != get<uint32_t>() ||
            component >= m_components.size())
            return refuse("a singleton that cannot be");
        const ComponentId id = m_components[component];
        if (id >= contents.singletons.size())
            contents.singletons.resize(id + size_t{1});
        contents.singletons[id] = entity;
    }
    return ok();
}

Result<void> restoreSnapshot(World& world, std::span<const std::byte> bytes)
{
    registerComponents<Name, Parent, PrefabPart>();
    WorldAccess access(world);
    access.assertStructural();
    const uint64_t version = world.version() + 1;
    SnapshotReader reader(bytes, version);
    if (const std::string error = reader.run(); !error.empty())
        return Error{error};
    access.replace(std::move(reader.contents), version);
    return {};
}

} // namespace penumbra::ecs
