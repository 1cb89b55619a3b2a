// Private to World: what it finds archetypes and queries by; the headers are heavy.
#pragma once

#include "runtime/ecs/world.h"

#include <memory>
#include <mutex>
#include <unordered_map>

namespace penumbra::ecs {

struct World::Index {
    std::unordered_map<ComponentMask, Archetype*, ComponentMask::Hash> byMask;
    std::mutex queryMutex;                            // to make or extend what follows
    std::vector<std::unique_ptr<QueryCache>> queries; // [slot]
    std::array<std::unique_ptr<QueryPage>, kMaxQueries / QueryPage::kSlots> queryPages;
};

} // namespace penumbra::ecs
