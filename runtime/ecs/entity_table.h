// EntityTable: where each entity's row is. 12 bytes per index ever used, outside the data blocks.
// Free indices are reused last-in first-out, so equal histories give equal ids.
#pragma once

#include "runtime/ecs/entity.h"

#include <vector>

namespace penumbra::ecs {

inline constexpr uint32_t kNone = ~0u;

struct EntityRecord {
    uint32_t generation = 1;    // of the living entity, or of the next one if the index is free
    uint32_t archetype = kNone; // kNone: the index is free
    uint32_t row = 0;
};

class EntityTable {
public:
    [[nodiscard]] bool alive(Entity entity) const
    {
        return entity.index < m_records.size() &&
               m_records[entity.index].generation == entity.generation &&
               m_records[entity.index].archetype != kNone;
    }

    // The new entity is alive once its record names an archetype, which the caller sets.
    Entity allocate()
    {
        ++m_count;
        if (m_free.empty()) {
            m_records.emplace_back();
            return {static_cast<uint32_t>(m_records.size() - 1), 1};
        }
        const uint32_t index = m_free.back();
        m_free.pop_back();
        return {index, m_records[index].generation};
    }

    void release(Entity entity)
    {
        EntityRecord& record = m_records[entity.index];
        record.archetype = kNone;
        --m_count;
        // The last generation below the deferred bit retires the index: no id ever comes back.
        if (++record.generation < (1u << 31))
            m_free.push_back(entity.index);
    }

    void reserveMore(size_t count) { m_records.reserve(m_records.size() + count); }

    [[nodiscard]] EntityRecord& operator[](Entity entity) { return m_records[entity.index]; }
    [[nodiscard]] const EntityRecord& operator[](Entity entity) const
    {
        return m_records[entity.index];
    }
    [[nodiscard]] uint32_t count() const { return m_count; }
    [[nodiscard]] uint32_t indexCount() const { return static_cast<uint32_t>(m_records.size()); }
    [[nodiscard]] size_t bytes() const
    {
        return m_records.capacity() * sizeof(EntityRecord) + m_free.capacity() * sizeof(uint32_t);
    }

private:
    friend class WorldAccess;

    std::vector<EntityRecord> m_records; // [index]
    std::vector<uint32_t> m_free;
    uint32_t m_count = 0;
};

} // namespace penumbra::ecs
