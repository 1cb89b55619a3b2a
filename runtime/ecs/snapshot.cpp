#include "runtime/ecs/snapshot.h"

#include "runtime/ecs/snapshot_format.h"
#include "runtime/ecs/snapshot_sink.h"
#include "runtime/ecs/world_access.h"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>

namespace penumbra::ecs {

namespace {

template <class Sink>
class Writer {
public:
    Writer(const World& world, Sink& sink) : m_world(world), m_sink(sink) {}

    void run()
    {
        m_sink.write(kSnapshotMagic, sizeof(kSnapshotMagic));
        put(kSnapshotMajor);
        put(kSnapshotMinor);
        putComponents();
        putEntities();
        putArchetypes();
        putHierarchy();
        putSingletons();
    }

private:
    template <class T>
    void put(const T& value)
    {
        static_assert(std::is_integral_v<T>);
        m_sink.write(&value, sizeof(value));
    }
    void putCount(size_t count) { put(static_cast<uint32_t>(count)); }

    // Those in use, by name.
    void putComponents()
    {
        ComponentMask used;
        for (const auto& archetype : WorldAccess::archetypes(m_world))
            used = used | archetype->mask();
        const std::vector<Entity>& singletons = WorldAccess::singletons(m_world);
        for (size_t id = 0; id < singletons.size(); ++id)
            if (m_world.alive(singletons[id]))
                used.set(static_cast<ComponentId>(id));
        used.forEach([&](ComponentId id) { m_components.push_back(id); });
        std::sort(m_components.begin(), m_components.end(), [](ComponentId a, ComponentId b) {
            return componentInfo(a).name < componentInfo(b).name;
        });
        putCount(m_components.size());
        for (const ComponentId id : m_components) {
            const ComponentInfo& info = componentInfo(id);
            put(static_cast<uint16_t>(info.name.size()));
            m_sink.write(info.name.data(), info.name.size());
            put(info.bytes);
            put(info.laneCount);
            put(layoutHash(info));
            put(static_cast<uint8_t>(info.save != nullptr));
        }
    }

    void putEntities()
    {
        const uint32_t count = WorldAccess::indexCount(m_world);
        putCount(count);
        for (uint32_t i = 0; i < count; ++i)
            put(WorldAccess::generation(m_world, i));
        const std::vector<uint32_t> free = WorldAccess::freeIndices(m_world);
        putCount(free.size());
        m_sink.write(free.data(), free.size() * sizeof(uint32_t));
    }

    void putArchetypes()
    {
        const auto archetypes = WorldAccess::archetypes(m_world);
        putCount(archetypes.size());
        for (const auto& archetype : archetypes) {
            uint16_t count = 0;
            archetype->mask().forEach([&](ComponentId) { ++count; });
            put(count);
            for (size_t i = 0; i < m_components.size(); ++i)
                if (archetype->mask().test(m_components[i]))
                    put(static_cast<uint16_t>(i));
            putCount(archetype->count());
            for (const Entity entity : archetype->entities())
                put(entity.index);
            std::vector<uint32_t> disabled;
            for (uint32_t row = 0; row < archetype->count(); ++row)
                if (archetype->disabled().test(row))
                    disabled.push_back(row);
            putCount(disabled.size());
            m_sink.write(disabled.data(), disabled.size() * sizeof(uint32_t));
            for (const ComponentId id : m_components)
                if (archetype->mask().test(id))
                    putValues(*archetype, id);
        }
    }

    void putValues(const Archetype& archetype, ComponentId id)
    {
        const ComponentInfo& info = componentInfo(id);
        if (info.save != nullptr) {
            std::vector<std::byte> bytes;
            for (uint32_t row = 0; row < archetype.count(); ++row) {
                bytes.clear();
                const int32_t column = archetype.columnOf(id);
                info.save(column < 0 ? nullptr : archetype.at(column, row), bytes);
                putCount(bytes.size());
                m_sink.write(bytes.data(), bytes.size());
            }
        } else if (info.isPlain() && info.bytes > 0) {
            for (uint32_t lane = 0; lane < info.laneCount; ++lane)
                putColumn(archetype, archetype.columnOf(id) + lane,
                          info.laneCount == 1 ? info.clearPadding : nullptr);
        }
    }

    void putColumn(const Archetype& archetype, uint32_t column, void (*clearPadding)(void*))
    {
        const uint32_t bytes = archetype.columns()[column].bytes;
        alignas(kMaxAlignment) static thread_local std::byte value[4096];
        if (clearPadding != nullptr && bytes <= sizeof(value)) {
            for (uint32_t row = 0; row < archetype.count(); ++row) {
                std::memcpy(value, archetype.at(column, row), bytes);
                clearPadding(value);
                m_sink.write(value, bytes);
            }
            return;
        }
        for (uint32_t row = 0; row < archetype.count(); row += archetype.blockRows()) // as it lies
            m_sink.write(archetype.at(column, row),
                         size_t{std::min(archetype.blockRows(), archetype.count() - row)} * bytes);
    }

    void putHierarchy()
    {
        const Hierarchy hierarchy = WorldAccess::freshHierarchy(m_world);
        putCount(hierarchy.order().size());
        for (const Hierarchy::Slot& slot : hierarchy.order()) {
            put(slot.entity.index);
            put(slot.parentSlot);
        }
    }

    void putSingletons()
    {
        const std::vector<Entity>& singletons = WorldAccess::singletons(m_world);
        std::vector<std::pair<uint16_t, Entity>> living;
        for (size_t i = 0; i < m_components.size(); ++i)
            if (m_components[i] < singletons.size() && m_world.alive(singletons[m_components[i]]))
                living.emplace_back(static_cast<uint16_t>(i), singletons[m_components[i]]);
        putCount(living.size());
        for (const auto& [component, entity] : living) {
            put(component);
            put(entity.index);
            put(entity.generation);
        }
    }

    const World& m_world;
    Sink& m_sink;
    std::vector<ComponentId> m_components; // in the order of the snapshot
};

} // namespace

uint64_t layoutHash(const ComponentInfo& info)
{
    std::string text;
    for (const Field& field : info.fields)
        text += fmt::format("{} {} {} {};", field.name, toString(field.type), field.offset,
                            field.bytes);
    return hashName(text);
}

Result<std::vector<std::byte>> takeSnapshot(const World& world)
{
    for (const auto& archetype : WorldAccess::archetypes(world)) {
        std::string refused;
        if (archetype->count() > 0)
            archetype->mask().forEach([&](ComponentId id) {
                const ComponentInfo& info = componentInfo(id);
                if (!info.isPlain() && info.save == nullptr)
                    refused = info.name;
            });
        if (!refused.empty())
            return Error{fmt::format("component {} of entity {} is not trivially copyable and has "
                                     "no saveBytes() and loadBytes(); write them, or remove the "
                                     "component before the snapshot",
                                     refused, toString(archetype->entities()[0]))};
    }
    MemorySink memory;
    Writer(world, memory).run();
    const uint64_t sum = snapshotChecksum(memory.bytes);
    memory.write(&sum, sizeof(sum));
    return std::move(memory.bytes);
}

uint64_t stateHash(const World& world)
{
    HashSink hash;
    Writer(world, hash).run();
    return hash.value();
}

} // namespace penumbra::ecs
