// What World tells about an entity: dump().
#include "runtime/ecs/world.h"

#include <fmt/format.h>

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
        if (info.life != nullptr) {
            text += fmt::format("  {} ({} bytes, not plain data)\n", info.name, info.bytes);
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

} // namespace penumbra::ecs
