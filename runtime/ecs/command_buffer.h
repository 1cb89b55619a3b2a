// CommandBuffer: structural changes written down now and made later, at one point.
//
//   const Entity spark = commands.create(Position{…}, Parent{ball}); // not real before playback
//   commands.add(spark, Burning{});
//   commands.destroy(old);
//   play(world, commands);
//
// One buffer per thread or system; several are played in the order given, so equal contents give
// equal worlds whatever recorded them first. All commands of one entity are merged: it moves once,
// however many components come and go. Rules, for commands that met a changed world:
//   - commands for an entity that is no longer alive are dropped and counted;
//   - destroy wins over everything else said about that entity, before or after;
//   - attaching to a parent that is no longer alive destroys the child: it shares the parent's
//   fate;
//   - parents change entity by entity, in the order of each one's first command; attaching that
//     would close a cycle is refused and counted, and the old parent stays;
//   - set() of a component that is absent by then is dropped and counted.
#pragma once

#include "runtime/ecs/hierarchy.h"

#include <cstring>
#include <utility>

namespace penumbra::ecs {

class World;

struct PlaybackStatistics {
    uint32_t commands = 0; // recorded
    uint32_t dropped = 0;  // for dead entities and absent components
    uint32_t refused = 0;  // cycles
    uint32_t moves = 0;    // rows that went to another archetype, new ones included
};

class CommandBuffer {
public:
    // Names the buffer in its deferred entities, so that they are not taken for another's. 12 bits.
    explicit CommandBuffer(uint32_t tag = 0) : m_tag(tag & 0xfff) {}
    CommandBuffer(CommandBuffer&& other) noexcept { swap(other); }
    CommandBuffer& operator=(CommandBuffer&& other) noexcept
    {
        swap(other);
        return *this;
    }
    ~CommandBuffer() { freeBoxes(); }

    // The entity may be used in this buffer at once, as a target and inside component values (the
    // fields in kEntityFields), until playback.
    template <class... Ts>
    Entity create(Ts&&... values)
    {
        const Entity entity{m_created++, deferredGeneration()};
        m_ops.emplace_back(entity, 0, ComponentId{0}, Kind::create);
        add(entity, std::forward<Ts>(values)...);
        return entity;
    }
    void destroy(Entity entity) { m_ops.emplace_back(entity, 0, ComponentId{0}, Kind::destroy); }

    // Adds or overwrites.
    template <class... Ts>
    void add(Entity entity, Ts&&... values)
    {
        (record(entity, Kind::add, std::forward<Ts>(values)), ...);
    }
    template <class T>
    void set(Entity entity, T&& value)
    {
        static_assert(!std::is_same_v<std::remove_cvref_t<T>, Parent>,
                      "setParent() changes parents");
        record(entity, Kind::set, std::forward<T>(value));
    }
    template <class... Ts>
    void remove(Entity entity)
    {
        (record(entity, componentId<Ts>(), Kind::remove, nullptr, 0), ...);
    }
    void setParent(Entity child, Entity parent) { add(child, Parent{parent}); }
    // As World::setEnabled(); done after all moves and before the destroys, in the order recorded.
    void setEnabled(Entity entity, bool enabled, Reach reach = Reach::entity)
    {
        m_ops.emplace_back(entity, static_cast<uint32_t>(reach), ComponentId{0},
                           enabled ? Kind::enable : Kind::disable);
    }

    [[nodiscard]] bool isEmpty() const { return m_ops.empty(); }
    [[nodiscard]] size_t count() const { return m_ops.size(); }
    void clear();

private:
    friend class CommandPlayback;

    enum class Kind : uint8_t { create, destroy, add, set, remove, enable, disable };
    struct Op {
        Entity target;
        uint32_t value; // offset in m_values; of enable, disable the reach
        uint8_t component;
        Kind kind;
        uint16_t buffer = 0; // this and next: for playback
        Op* next = nullptr;  // of the same entity, in any buffer
        Op(Entity entity, uint32_t valueOffset, ComponentId id, Kind opKind)
            : target(entity), value(valueOffset), component(static_cast<uint8_t>(id)), kind(opKind)
        {}
    };
    static_assert(kMaxComponents <= 256, "component ids fit a byte");
    static_assert(sizeof(Op) == 24);

    // Top bit: deferred. Then the tag, then as much of the epoch as fits: enough to catch misuse.
    [[nodiscard]] uint32_t deferredGeneration() const
    {
        return 1u << 31 | m_tag << 19 | (m_epoch & 0x7ffff);
    }
    void record(Entity entity, ComponentId id, Kind kind, const void* value, size_t bytes);
    template <class Value>
    void record(Entity entity, Kind kind, Value&& value)
    {
        using T = std::remove_cvref_t<Value>;
        if constexpr (kIsPlain<T> || kIsTag<T>) {
            record(entity, componentId<T>(), kind, &value, kIsTag<T> ? 0 : sizeof(T));
        } else { // lies in a box of its own; Op::value is its index
            m_boxes.push_back({nullptr, [](void* box) { delete static_cast<T*>(box); }});
            m_boxes.back().value = new T(std::forward<Value>(value));
            m_ops.emplace_back(entity, static_cast<uint32_t>(m_boxes.size() - 1), componentId<T>(),
                               kind);
        }
    }
    [[nodiscard]] std::byte* valueAt(ComponentId id, uint32_t value)
    {
        return componentInfo(id).life != nullptr ? static_cast<std::byte*>(m_boxes[value].value)
                                                 : m_values.data() + value;
    }
    void swap(CommandBuffer& other) noexcept;
    void freeBoxes();

    struct Box {
        void* value;
        void (*free)(void* value);
    };

    std::vector<Op> m_ops;
    std::vector<std::byte> m_values; // trivially copyable ones
    std::vector<Box> m_boxes;        // others, owned
    uint32_t m_created = 0;
    uint32_t m_epoch = 0; // playbacks so far
    uint32_t m_tag = 0;
};

// Makes the changes, in the order given, and empties the buffers.
PlaybackStatistics play(World& world, std::span<CommandBuffer* const> buffers);
PlaybackStatistics play(World& world, CommandBuffer& buffer);

} // namespace penumbra::ecs
