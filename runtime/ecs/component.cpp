#include "runtime/ecs/component.h"

#include "runtime/assert.h"
#include "runtime/ecs/entity_table.h"

#include <atomic>
#include <fmt/format.h>
#include <mutex>
#include <unordered_map>

namespace penumbra::ecs {

namespace {

struct Registry {
    std::mutex mutex;
    std::array<ComponentInfo, kMaxComponents> infos; // fixed: read without the mutex
    std::atomic<uint32_t> count = 0;
    std::unordered_map<uint64_t, ComponentId> byHash;
    std::unordered_map<ComponentMask, uint32_t, ComponentMask::Hash> sets;
};

// Inside a function: components register from static initialisers of any file.
Registry& registry()
{
    static Registry instance;
    return instance;
}

} // namespace

uint64_t hashName(std::string_view name)
{
    uint64_t hash = 0xcbf29ce484222325u;
    for (const char c : name)
        hash = (hash ^ static_cast<uint8_t>(c)) * 0x100000001b3u;
    return hash;
}

// [ComponentId], for debug/gdb_printers.py: a name that debuggers find.
extern const ComponentInfo* debuggedComponents;
const ComponentInfo* debuggedComponents = nullptr;

std::string toString(Entity entity)
{
    return entity.isNull() ? "null" : fmt::format("{}#{}", entity.index, entity.generation);
}

ComponentId registerComponent(const ComponentInfo& info)
{
    Registry& all = registry();
    const std::lock_guard lock(all.mutex);
    const uint64_t hash = hashName(info.name);
    if (const auto found = all.byHash.find(hash); found != all.byHash.end()) {
        const ComponentInfo& known = all.infos[found->second];
        PENUMBRA_ASSERT(known.name == info.name, "components '{}' and '{}' have one hash: rename",
                        known.name, info.name);
        PENUMBRA_ASSERT(known.bytes == info.bytes && known.laneCount == info.laneCount &&
                            known.laneAlignment == info.laneAlignment &&
                            known.rowChanges == info.rowChanges &&
                            (known.life == nullptr) == (info.life == nullptr),
                        "component '{}' has two layouts ({} and {} bytes): two types, one name?",
                        info.name, known.bytes, info.bytes);
        return found->second;
    }
    const uint32_t count = all.count.load(std::memory_order_relaxed);
    PENUMBRA_ASSERT(count < kMaxComponents, "'{}' is one component too many ({} fit)", info.name,
                    kMaxComponents);
    const auto id = static_cast<ComponentId>(count);
    all.infos[id] = info;
    debuggedComponents = all.infos.data();
    all.infos[id].nameHash = hash;
    all.byHash.emplace(hash, id);
    all.count.store(count + 1, std::memory_order_release);
    return id;
}

const ComponentInfo& componentInfo(ComponentId id)
{
    PENUMBRA_DEBUG_ASSERT(id < componentCount(), "component id {} of {}", id, componentCount());
    return registry().infos[id];
}

uint32_t findComponent(std::string_view name)
{
    Registry& all = registry();
    const std::lock_guard lock(all.mutex);
    const auto found = all.byHash.find(hashName(name));
    return found == all.byHash.end() ? kNone : found->second;
}

uint32_t componentCount()
{
    return registry().count.load(std::memory_order_acquire);
}

std::string toString(const ComponentMask& mask)
{
    std::string text;
    mask.forEach([&](ComponentId id) {
        if (!text.empty())
            text += ", ";
        text += componentInfo(id).name;
    });
    return text;
}

ComponentSet registerComponentSet(const ComponentMask& mask)
{
    Registry& all = registry();
    const std::lock_guard lock(all.mutex);
    return {mask, all.sets.emplace(mask, static_cast<uint32_t>(all.sets.size())).first->second};
}

} // namespace penumbra::ecs
