// What World tells about itself: dump() and statistics().
#include "runtime/ecs/world.h"

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

std::string valueText(const std::vector<std::byte>& value)
{
    std::string text;
    for (size_t at = 0; at < value.size(); at += 4) {
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
    std::string text = fmt::format("entity {}, archetype {}, row {}\n", toString(entity),
                                   at.archetype->index(), at.row);
    at.archetype->mask().forEach([&](ComponentId id) {
        const ComponentInfo& info = componentInfo(id);
        const int32_t column = at.archetype->columnOf(id);
        if (column < 0) {
            text += fmt::format("  {} (tag)\n", info.name);
            return;
        }
        std::vector<std::byte> value(info.bytes);
        at.archetype->read(id, at.row, value.data());
        const uint32_t segment = at.row >> at.archetype->segmentShift();
        text += fmt::format("  {} ({} bytes, version {}): {}\n", info.name, info.bytes,
                            at.archetype->version(column, segment),
                            id == componentId<Parent>() ? toString(m_hierarchy.parentOf(entity))
                                                        : valueText(value));
    });
    for (const Entity child : m_hierarchy.childrenOf(entity))
        text += fmt::format("  child {}\n", toString(child));
    return text;
}

WorldStatistics World::statistics() const
{
    WorldStatistics all;
    all.entities = count();
    all.archetypes = static_cast<uint32_t>(m_archetypes.size());
    for (const auto& archetype : m_archetypes) {
        all.segments += archetype->segmentCount();
        all.valueBytes += archetype->valueBytes();
        all.blockBytes += archetype->blockBytes();
        all.bookBytes += archetype->bookBytes();
    }
    all.bookBytes += m_entities.bytes() + m_hierarchy.bytes();
    for (const auto& query : m_queries)
        all.bookBytes += query ? query->bytes() : 0;
    return all;
}

} // namespace penumbra::ecs
