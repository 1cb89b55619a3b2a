// DestroyedLog: what the last destroyed entities were, for the message about a stale Entity.
#pragma once

#include "runtime/ecs/component_mask.h"
#include "runtime/ecs/entity.h"

#include <algorithm>
#include <string>
#include <vector>

namespace penumbra::ecs {

class DestroyedLog {
public:
    struct Entry {
        Entity entity;
        ComponentMask components;
        std::string name; // may be empty
    };
    static constexpr uint32_t kCapacity = 1024; // some frames of a busy scene

    void add(Entity entity, const ComponentMask& components, std::string name)
    {
        Entry entry{entity, components, std::move(name)};
        if (m_entries.size() < kCapacity)
            m_entries.push_back(std::move(entry));
        else
            m_entries[m_next++ % kCapacity] = std::move(entry);
    }
    // Null if it was never destroyed, or too long ago.
    [[nodiscard]] const Entry* find(Entity entity) const
    {
        const auto found = std::find_if(m_entries.begin(), m_entries.end(),
                                        [&](const Entry& e) { return e.entity == entity; });
        return found == m_entries.end() ? nullptr : &*found;
    }

private:
    std::vector<Entry> m_entries; // ring once full
    uint32_t m_next = 0;
};

} // namespace penumbra::ecs
