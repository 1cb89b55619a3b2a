// SystemContext: all that a system sees of the world. It may read and write the components that it
// declared (asserted in debug builds), look at structure, and record commands for later.
#pragma once

#include "runtime/assert.h"
#include "runtime/ecs/command_buffer.h"
#include "runtime/ecs/world.h"

namespace penumbra::ecs {

// What a system touches: Access::of<const Velocity, Position>() reads Velocity, writes Position.
// Writing includes reading. Tags, presence and the hierarchy's links need no declaration: they
// change only when no system runs.
struct Access {
    ComponentMask reads, writes;

    template <class... Ts>
    static Access of()
    {
        Access access;
        ((std::is_const_v<Ts> ? access.reads : access.writes)
             .set(componentId<std::remove_const_t<Ts>>()),
         ...);
        return access;
    }
    [[nodiscard]] bool conflictsWith(const Access& other) const
    {
        return writes.intersects(other.writes | other.reads) || reads.intersects(other.writes);
    }
};

class SystemContext {
public:
    SystemContext(World& world, CommandBuffer& commands, std::string_view name,
                  const Access& access, Stamp stamp, uint64_t lastRun)
        : m_world(world), m_commands(commands), m_name(name), m_access(access), m_stamp(stamp),
          m_lastRun(lastRun)
    {}

    // Changed<> terms pass what others wrote since this system last ran.
    template <class... Terms>
    [[nodiscard]] Query<Terms...> query() const
    {
        (check<Terms>(), ...);
        const Query<Terms...> query(m_world.cacheOf<Query<Terms...>>(), m_stamp, m_lastRun,
                                    m_world.m_iterating);
        __atomic_fetch_add(&m_rows, uint64_t{query.count()}, __ATOMIC_RELAXED);
        return query;
    }

    [[nodiscard]] bool alive(Entity entity) const { return m_world.alive(entity); }
    template <class T>
    [[nodiscard]] bool has(Entity entity) const
    {
        return m_world.has<T>(entity);
    }
    [[nodiscard]] bool isEnabled(Entity entity) const { return m_world.isEnabled(entity); }
    // As in World: T marks, const T does not.
    template <class T>
    [[nodiscard]] T* tryGet(Entity entity) const
    {
        check<T>();
        return m_world.find<T>(entity, m_stamp);
    }
    template <class T>
    [[nodiscard]] T& get(Entity entity) const
    {
        T* value = tryGet<T>(entity);
        if (value == nullptr) [[unlikely]]
            m_world.failMissing(entity, componentId<std::remove_const_t<T>>());
        return *value;
    }
    template <class T>
    [[nodiscard]] T value(Entity entity) const
    {
        check<const T>();
        return m_world.value<T>(entity);
    }
    template <class T>
    void set(Entity entity, const T& value) const
    {
        check<T>();
        m_world.setStamped(entity, value, m_stamp);
    }
    template <class T>
    [[nodiscard]] T& singleton() const
    {
        return get<T>(m_world.singletonEntity<std::remove_const_t<T>>());
    }

    [[nodiscard]] const Hierarchy& hierarchy() const { return m_world.m_hierarchy; }
    // Played after the last system of the frame. For one thread: not from inside parallelEach.
    [[nodiscard]] CommandBuffer& commands() const { return m_commands; }
    [[nodiscard]] uint64_t version() const { return m_stamp.version; }
    [[nodiscard]] uint64_t lastRun() const { return m_lastRun; } // version; 0 the first time
    // In the queries made so far.
    [[nodiscard]] uint64_t rows() const { return __atomic_load_n(&m_rows, __ATOMIC_RELAXED); }

private:
    template <class Term>
    void check() const
    {
        using Traits = TermTraits<Term>;
        if constexpr (Traits::kKind == TermKind::data || Traits::kKind == TermKind::changed) {
            [[maybe_unused]] const ComponentId id = componentId<typename Traits::Component>();
            PENUMBRA_DEBUG_ASSERT(m_access.writes.test(id) ||
                                      (!kWrites<Term> && m_access.reads.test(id)),
                                  "system '{}' {} {} without declaring it", m_name,
                                  kWrites<Term> ? "writes" : "reads", componentInfo(id).name);
        }
    }

    World& m_world;
    CommandBuffer& m_commands;
    std::string_view m_name;
    [[maybe_unused]] const Access& m_access; // asserts of debug builds
    Stamp m_stamp;
    uint64_t m_lastRun;
    mutable uint64_t m_rows = 0; // several threads count
};

} // namespace penumbra::ecs
