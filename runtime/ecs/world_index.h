// Private to World: what it finds archetypes and queries by; the headers are heavy.
#pragma once

#include "runtime/ecs/world.h"

#include <array>
#include <atomic>
#include <mutex>
#include <unordered_map>

namespace penumbra::ecs {

// Queries by slot, in pages that never move: systems look theirs up at once, without the lock.
inline constexpr uint32_t kQueryPages = 64;
inline constexpr uint32_t kQueriesPerPage = 64;

struct World::Index {
    std::unordered_map<ComponentMask, Archetype*, ComponentMask::Hash> byMask;
    std::mutex queryMutex;
    std::array<std::atomic<std::atomic<QueryCache*>*>, kQueryPages> queries{};

    ~Index()
    {
        for (const auto& page : queries) {
            for (uint32_t i = 0; page != nullptr && i < kQueriesPerPage; ++i)
                delete page[i].load();
            delete[] page.load();
        }
    }
};

} // namespace penumbra::ecs
