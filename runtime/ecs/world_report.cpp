// What World tells about itself: dump() and statistics().
#include "runtime/ecs/debug_hooks.h"
#include "runtime/ecs/world_index.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>

namespace penumbra::ecs {

namespace {

// Values have no field types here: a word that is a likely float is shown as one, others as
// integers, which suits positions, colours, counts and handles alike.
std::string wordText(uint32_t word)
{
    const float number = std::bit_cast<float>(word);
    const float size = std::abs(number);
    return size > 1e-6f && size < 1e9f ? fmt::format("{:.6g}", number) : fmt::format("{}", word);
}

std::string valueText(ComponentId id, const std::vector<std::byte>& value)
{
    const DebugHooks& hooks = debugHooks();
    std::string text = hooks.value != nullptr ? hooks.value(id, value.data()) : std::string();
    if (!text.empty())
        return text;
    const std::span<const uint32_t> entities = componentInfo(id).entityFields;
    for (size_t at = 0; at < value.size(); at += 4) {
        if (std::find(entities.begin(), entities.end(), at) != entities.end()) {
            Entity entity;
            std::memcpy(&entity, value.data() + at, sizeof(entity));
            text += fmt::format("{}{}", at == 0 ? "" : " ", toString(entity));
            at += sizeof(entity) - 4;
            continue;
        }
        uint32_t word = 0;
        std::memcpy(&word, value.data() + at, std::min<size_t>(4, value.size() - at));
        text += at == 0 ? "" : " ";
        text += wordText(word);
    }
    return text;
}

} // namespace

std::string World::dump(Entity entity) const
{
    const Place at = place(entity);
    std::string text =
        fmt::format("entity {}, {}archetype {}, row {}\n", describe(entity),
                    isEnabled(entity) ? "" : "disabled, ", at.archetype->index(), at.row);
    if (const Entity parent = m_hierarchy.parentOf(entity); !parent.isNull())
        text += fmt::format("  parent {}\n", describe(parent));
    at.archetype->mask().forEach([&](ComponentId id) {
        const ComponentInfo& info = componentInfo(id);
        const int32_t column = at.archetype->columnOf(id);
        if (column < 0) {
            text += fmt::format("  {} (tag)\n", info.name);
            return;
        }
        if (info.life != nullptr) {
            text += fmt::format("  {} ({} bytes, not plain data)\n", info.name, info.bytes);
            return;
        }
        std::vector<std::byte> value(info.bytes);
        at.archetype->read(id, at.row, value.data());
        const uint32_t segment = at.row >> at.archetype->segmentShift();
        text += fmt::format("  {} ({} bytes, version {}): {}\n", info.name, info.bytes,
                            at.archetype->version(column, segment), valueText(id, value));
    });
    for (const Entity child : m_hierarchy.childrenOf(entity))
        text += fmt::format("  child {}\n", describe(child));
    return text;
}

WorldStatistics World::statistics() const
{
    WorldStatistics all;
    all.entities = count();
    all.archetypes = static_cast<uint32_t>(m_archetypes.size());
    for (const Archetype* archetype : m_archetypes) {
        const ArchetypeStatistics one{
            .components = archetype->mask(),
            .rows = archetype->count(),
            .disabledRows = archetype->disabled().count(),
            .segments = archetype->segmentCount(),
            .valueBytes = archetype->valueBytes(),
            .blockBytes = archetype->blockBytes(),
            .bookBytes = archetype->bookBytes(),
        };
        all.disabled += one.disabledRows;
        all.segments += one.segments;
        all.valueBytes += one.valueBytes;
        all.blockBytes += one.blockBytes;
        all.bookBytes += one.bookBytes;
        all.perArchetype.push_back(one);
    }
    all.bookBytes += sizeof(*this) + sizeof(*m_index) + m_entities.bytes() + m_hierarchy.bytes();
    all.bookBytes += m_archetypes.capacity() * sizeof(Archetype*) +
                     m_bySet.capacity() * sizeof(Archetype*) +
                     (m_singletons.capacity() + m_doomed.capacity()) * sizeof(Entity) +
                     (m_mergeSlots.capacity() + m_leaving.capacity()) * sizeof(uint32_t);
    // A node of the map: key, value, link, hash; and its bucket.
    all.bookBytes += m_index->byMask.size() * (sizeof(ComponentMask) + 3 * sizeof(void*)) +
                     m_index->byMask.bucket_count() * sizeof(void*);
    for (const std::unique_ptr<QueryPage>& page : m_index->queryPages)
        all.bookBytes += page != nullptr ? sizeof(QueryPage) : 0;
    for (const std::unique_ptr<QueryCache>& cache : m_index->queries)
        all.bookBytes += sizeof(cache) + (cache != nullptr ? sizeof(*cache) + cache->bytes() : 0);
    return all;
}

std::string toString(const WorldStatistics& statistics)
{
    const auto kib = [](size_t bytes) { return (bytes + 1023) / 1024; };
    std::string text = fmt::format(
        "{} entities ({} disabled), {} archetypes, {} segments; KiB: {} values, {} blocks, {} "
        "books\n{:>9} {:>9} {:>9} {:>9} {:>9}  components\n",
        statistics.entities, statistics.disabled, statistics.archetypes, statistics.segments,
        kib(statistics.valueBytes), kib(statistics.blockBytes), kib(statistics.bookBytes), "rows",
        "disabled", "values", "blocks", "books");
    for (const ArchetypeStatistics& one : statistics.perArchetype)
        text += fmt::format("{:>9} {:>9} {:>9} {:>9} {:>9}  {}\n", one.rows, one.disabledRows,
                            kib(one.valueBytes), kib(one.blockBytes), kib(one.bookBytes),
                            one.components.isEmpty() ? "-" : toString(one.components));
    return text;
}

} // namespace penumbra::ecs
