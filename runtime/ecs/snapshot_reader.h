// Private to snapshots: all of one read into WorldAccess::Contents, checked. Format:
// snapshot_format.h.
#pragma once

#include "runtime/ecs/snapshot_source.h"
#include "runtime/ecs/world_access.h"

#include <unordered_map>

namespace penumbra::ecs {

class SnapshotReader : SnapshotSource {
public:
    SnapshotReader(std::span<const std::byte> bytes, uint64_t version)
        : SnapshotSource(bytes), m_stamp{version, version - 1}
    {}

    std::string run(); // empty: read

    WorldAccess::Contents contents;

private:
    bool readHead();
    bool readComponents();
    bool readEntities();
    bool readArchetypes();
    bool readRows(Archetype& archetype, const std::vector<ComponentId>& components);
    bool readValues(Archetype& archetype, ComponentId id);
    [[nodiscard]] Entity living(uint32_t index);
    [[nodiscard]] Entity parentValue(Entity entity);
    bool readHierarchy();
    bool readSingletons();

    Stamp m_stamp;
    std::vector<ComponentId> m_components; // by place in the snapshot
    ComponentMask m_known;
    std::vector<bool> m_isFree; // [entity index]
    std::unordered_map<ComponentMask, uint32_t, ComponentMask::Hash> m_masks;
};

} // namespace penumbra::ecs
