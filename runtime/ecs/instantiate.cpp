#include "runtime/assert.h"
#include "runtime/ecs/prefab.h"
#include "runtime/ecs/world_access.h"

#include <unordered_map>

namespace penumbra::ecs {

// One call of instantiate().
class Instantiation {
public:
    Instantiation(World& world, const Prefab& prefab, uint32_t copies)
        : m_world(world), m_prefab(prefab), m_copies(copies),
          m_out(size_t{copies} * prefab.partCount()), m_places(prefab.partCount())
    {}

    std::vector<Entity> run()
    {
        m_world.assertStructural();
        m_world.allocate(m_out);
        std::vector<std::pair<ComponentMask, std::vector<uint32_t>>> groups; // parts by archetype
        std::unordered_map<ComponentMask, size_t, ComponentMask::Hash> groupOf;
        for (uint32_t i = 0; i < m_prefab.partCount(); ++i) {
            const ComponentMask& mask = m_prefab.components(i);
            const auto [at, isNew] = groupOf.emplace(mask, groups.size());
            if (isNew)
                groups.emplace_back(mask, std::vector<uint32_t>{});
            groups[at->second].second.push_back(i);
        }
        for (const auto& [mask, parts] : groups)
            fill(m_world.archetypeOf(mask), parts);
        for (uint32_t i = 0; i < m_prefab.partCount(); ++i)
            for (const Prefab::Value& value : m_prefab.m_parts[i].values)
                resolve(i, value);
        attach();
        return std::move(m_out);
    }

private:
    void fill(Archetype& archetype, const std::vector<uint32_t>& parts)
    {
        std::vector<Entity> entities;
        entities.reserve(parts.size() * m_copies);
        for (const uint32_t part : parts)
            for (uint32_t copy = 0; copy < m_copies; ++copy)
                entities.push_back(entityOf(copy, part));
        uint32_t row = m_world.append(archetype, entities);
        for (const uint32_t part : parts) {
            m_places[part] = {&archetype, row};
            for (const Prefab::Value& value : m_prefab.m_parts[part].values)
                archetype.fill(value.id, row, m_copies, m_prefab.m_bytes.data() + value.offset, 0);
            row += m_copies;
        }
    }

    // Writes a value again for each copy if it names parts.
    void resolve(uint32_t part, const Prefab::Value& value)
    {
        const ComponentInfo& info = componentInfo(value.id);
        if (info.entityFields.empty())
            return;
        const std::byte* original = m_prefab.m_bytes.data() + value.offset;
        std::vector<std::byte> bytes(original, original + info.bytes);
        for (uint32_t copy = 0; copy < m_copies; ++copy) {
            bool names = false;
            for (const uint32_t field : info.entityFields) {
                Entity entity;
                std::memcpy(&entity, original + field, sizeof(entity));
                if (!entity.isDeferred())
                    continue;
                PENUMBRA_ASSERT(entity.index < m_prefab.partCount(),
                                "{} of part {} names part {} of {}", info.name, part, entity.index,
                                m_prefab.partCount());
                entity = entityOf(copy, entity.index);
                std::memcpy(bytes.data() + field, &entity, sizeof(entity));
                names = true;
            }
            if (!names)
                return;
            m_places[part].archetype->write(value.id, m_places[part].row + copy, bytes.data());
        }
    }

    void attach()
    {
        std::vector<std::pair<uint32_t, Entity>> children; // part, its Parent as the prefab has it
        for (uint32_t i = 0; i < m_prefab.partCount(); ++i)
            if (const std::byte* value = m_prefab.find(i, componentId<Parent>())) {
                Parent parent;
                std::memcpy(&parent, value, sizeof(parent));
                children.emplace_back(i, parent.entity);
            }
        for (uint32_t copy = 0; copy < m_copies; ++copy)
            for (const auto& [part, parent] : children)
                m_world.attach(entityOf(copy, part),
                               parent.isDeferred() ? entityOf(copy, parent.index) : parent);
    }

    [[nodiscard]] Entity entityOf(uint32_t copy, uint32_t part) const
    {
        return m_out[size_t{copy} * m_prefab.partCount() + part];
    }

    WorldAccess m_world;
    const Prefab& m_prefab;
    uint32_t m_copies;
    std::vector<Entity> m_out;
    std::vector<Place> m_places; // [part] the first copy's
};

std::vector<Entity> instantiateUntold(World& world, const Prefab& prefab, uint32_t copies)
{
    return Instantiation(world, prefab, copies).run();
}

std::vector<Entity> instantiate(World& world, const Prefab& prefab, uint32_t copies)
{
    std::vector<Entity> made = instantiateUntold(world, prefab, copies);
    WorldAccess(world).tellCreated(made);
    return made;
}

} // namespace penumbra::ecs
