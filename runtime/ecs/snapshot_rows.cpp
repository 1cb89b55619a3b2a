// Reading of snapshots: archetypes, their rows and values.
#include "runtime/ecs/snapshot_reader.h"

#include <algorithm>
#include <cstring>

namespace penumbra::ecs {

bool SnapshotReader::readArchetypes()
{
    const uint32_t count = getCount(sizeof(uint16_t) + 2 * sizeof(uint32_t));
    constexpr uint32_t kMaxArchetypes = 1u << 16; // each takes a KiB
    if (count > kMaxArchetypes)
        return refuse(fmt::format("{} archetypes", count));
    uint32_t entities = 0;
    for (uint32_t i = 0; i < count && ok(); ++i) {
        ComponentMask mask;
        std::vector<ComponentId> components(getCount<uint16_t>(sizeof(uint16_t)));
        for (ComponentId& id : components) {
            const auto index = get<uint16_t>();
            if (index >= m_components.size() || mask.test(m_components[index]))
                return refuse("an archetype's component that cannot be");
            id = m_components[index];
            mask.set(id);
        }
        if (!ok() || !m_masks.emplace(mask, i).second || (i == 0) != mask.isEmpty())
            return refuse("an archetype twice, or none that is empty");
        auto archetype = std::make_unique<Archetype>(i, mask);
        const bool read = readRows(*archetype, components);
        entities += archetype->count();
        contents.archetypes.push_back(std::move(archetype));
        if (!read)
            return false;
    }
    uint32_t accounted = entities + static_cast<uint32_t>(contents.free.size());
    for (const auto& record : contents.records)
        accounted += record.generation == 1u << 31; // retired
    if (!ok() || count == 0 || accounted != contents.records.size())
        return refuse("an index that neither lives nor is free");
    contents.count = entities;
    return true;
}

bool SnapshotReader::readRows(Archetype& archetype, const std::vector<ComponentId>& components)
{
    std::vector<Entity> entities(getCount(sizeof(uint32_t)));
    for (uint32_t row = 0; row < entities.size(); ++row) {
        const auto index = get<uint32_t>();
        if (index >= contents.records.size() || m_isFree[index] ||
            contents.records[index].archetype != kNone ||
            contents.records[index].generation == 1u << 31)
            return refuse("a row of an entity that cannot be");
        auto& record = contents.records[index];
        entities[row] = {index, record.generation};
        record.archetype = archetype.index();
        record.row = row;
    }
    std::vector<uint32_t> disabled(getCount(sizeof(uint32_t)));
    for (uint32_t& row : disabled) {
        row = get<uint32_t>();
        if (row >= entities.size())
            return refuse("a disabled row that is not there");
    }
    // Before any memory of the rows: are their values there?
    size_t bytes = 0;
    for (const ComponentId id : components) {
        if (!entities.empty() && !componentInfo(id).isPlain() && componentInfo(id).save == nullptr)
            return refuse("values that nothing reads");
        bytes += componentInfo(id).save != nullptr ? sizeof(uint32_t) : componentInfo(id).bytes;
    }
    if (bytes > 0 && entities.size() > m_bytes.size() / bytes)
        return refuse("it ends too early");
    if (entities.empty())
        return ok();
    archetype.reserve(static_cast<uint32_t>(entities.size()));
    // Every row is a value, whatever is wrong with the bytes: the archetype can be thrown away.
    for (const ComponentId id : components)
        if (componentInfo(id).save != nullptr && archetype.columnOf(id) >= 0)
            for (uint32_t row = 0; row < entities.size(); ++row)
                componentInfo(id).construct(archetype.at(archetype.columnOf(id), row));
    archetype.append(entities, m_stamp);
    for (const uint32_t row : disabled)
        archetype.setDisabled(row, true, m_stamp);
    for (const ComponentId id : components)
        if (!readValues(archetype, id))
            return false;
    return true;
}

bool SnapshotReader::readValues(Archetype& archetype, ComponentId id)
{
    const ComponentInfo& info = componentInfo(id);
    const int32_t column = archetype.columnOf(id);
    if (info.save != nullptr) {
        for (uint32_t row = 0; row < archetype.count(); ++row) {
            const auto bytes = take(get<uint32_t>());
            if (!ok())
                return false;
            if (column >= 0 && !info.load(archetype.at(column, row), bytes))
                return refuse(fmt::format("a value of {} that loadBytes() refuses", info.name));
        }
        return true;
    }
    for (uint32_t lane = 0; info.bytes > 0 && lane < info.laneCount; ++lane) {
        const uint32_t bytes = archetype.columns()[column + lane].bytes;
        for (uint32_t row = 0; row < archetype.count(); row += archetype.blockRows()) {
            const auto values =
                take(size_t{std::min(archetype.blockRows(), archetype.count() - row)} * bytes);
            if (!ok())
                return false;
            std::memcpy(archetype.at(column + lane, row), values.data(), values.size());
        }
    }
    return true;
}

} // namespace penumbra::ecs
