// World: entities and their components, stored as archetypes (archetype.h).
//
//   World world;
//   const Entity ball = world.create(Position{0, 2, 0}, Velocity{1, 0, 0}, Visible{});
//   world.query<Position, const Velocity>().each([&](Position& p, const Velocity& v) { … });
//   if (const Position* p = world.tryGet<const Position>(ball)) …
//
// Change marks: whoever asks for a T& or T* marks it as changed, whether or not it writes; a
// const T& or const T* marks nothing. New rows, and rows that move because of a structural change,
// count as changed. advance() starts a new version; Query::since(v) then finds later changes.
//
// References, pointers and Segment arrays stay valid until the next structural change (create,
// destroy, add, remove, attach). Structural changes during an iteration, and any access past the
// SystemContext while a Schedule runs, assert in debug builds; a stale Entity asserts in all
// builds. One thread at a time, except through a Schedule and Query::parallelEach.
#pragma once

#include "runtime/ecs/hierarchy.h"
#include "runtime/ecs/query.h"

#include <mutex>
#include <unordered_map>

namespace penumbra::ecs {

struct WorldStatistics {
    uint32_t entities = 0, archetypes = 0, segments = 0;
    size_t valueBytes = 0; // of living components
    size_t blockBytes = 0; // allocated for them
    size_t bookBytes = 0;  // ids, versions, change bits, entity table, hierarchy, query caches
};

class World {
public:
    World();
    World(const World&) = delete;
    World& operator=(const World&) = delete;

    // --- Entities. All components arrive in one move.
    template <class... Ts>
    Entity create(const Ts&... values);
    // out.size() entities. Each argument is one value for all of them, or a
    // std::span<const T> of out.size() values.
    template <class... Arguments>
    void createMany(std::span<Entity> out, const Arguments&... arguments);
    // With everything below it in the hierarchy.
    void destroy(Entity entity);
    // All alive and, for that, distinct; entities below others in the list are fine.
    void destroyMany(std::span<const Entity> entities);
    [[nodiscard]] bool alive(Entity entity) const { return m_entities.alive(entity); }
    [[nodiscard]] uint32_t count() const { return m_entities.count(); }

    // --- Components. add overwrites what is there; set needs it there; remove ignores absence.
    template <class... Ts>
    void add(Entity entity, const Ts&... values);
    template <class T>
    void set(Entity entity, const T& value);
    template <class... Ts>
    void remove(Entity entity);
    template <class T>
    [[nodiscard]] bool has(Entity entity) const;
    // get<T> marks, get<const T> does not. A lane-split component has no address: value() and
    // set().
    template <class T>
    [[nodiscard]] T& get(Entity entity);
    template <class T>
    [[nodiscard]] const T& get(Entity entity) const;
    template <class T>
    [[nodiscard]] T* tryGet(Entity entity); // null if absent
    template <class T>
    [[nodiscard]] const T* tryGet(Entity entity) const;
    template <class T>
    [[nodiscard]] T value(Entity entity) const;

    // --- Singletons: one value of a type, on an entity of its own.
    template <class T>
    Entity setSingleton(const T& value);
    template <class T>
    [[nodiscard]] T& singleton();
    template <class T>
    [[nodiscard]] const T& singleton() const;
    template <class T>
    [[nodiscard]] bool hasSingleton() const;

    // --- Queries: query.h.
    template <class... Terms>
    [[nodiscard]] Query<Terms...> query();
    template <class... Terms>
    requires(Query<Terms...>::kReadOnly) [[nodiscard]] Query<Terms...> query() const;

    // --- Hierarchy: hierarchy.h.
    // False, and nothing changed, if `child` is `parent` or above it.
    [[nodiscard]] bool setParent(Entity child, Entity parent);
    void clearParent(Entity child) { remove<Parent>(child); }
    [[nodiscard]] const Hierarchy& hierarchy();

    // --- Versions. Writes are stamped with version(); to look for changes, keep version(), then
    // advance(), and later ask for what was written since.
    [[nodiscard]] uint64_t version() const { return m_stamp.version; }
    void advance() { m_stamp = {m_stamp.version + 1, m_stamp.version}; }

    // --- Looking inside.
    // One line per component: name, bytes, version, words as numbers.
    [[nodiscard]] std::string dump(Entity entity) const;
    [[nodiscard]] WorldStatistics statistics() const;
    [[nodiscard]] ComponentMask components(Entity entity) const;
    void trim(); // gives back memory that holds no rows; else it is kept for the next ones

private:
    friend class SystemContext;
    friend class Schedule;
    friend class CommandPlayback;
    friend class WorldAccess;

    struct Place {
        Archetype* archetype;
        uint32_t row;
    };
    [[nodiscard]] Place place(Entity entity) const
    {
        if (!m_entities.alive(entity)) [[unlikely]]
            failStale(entity);
        const EntityRecord& record = m_entities[entity];
        return {m_archetypes[record.archetype].get(), record.row};
    }
    [[noreturn]] void failStale(Entity entity) const;
    [[noreturn]] void failMissing(Entity entity, ComponentId id) const;
    void assertStructural() const;
    void assertOutsideSystems() const;

    [[nodiscard]] Archetype& archetypeOf(const ComponentMask& mask);
    [[nodiscard]] Archetype& archetypeOf(const ComponentSet& set);
    [[nodiscard]] const QueryCache& cacheOf(uint32_t querySlot) const;
    Place createIn(const ComponentSet& set);
    Archetype& createManyIn(const ComponentSet& set, std::span<Entity> out);
    Place addSet(Entity entity, const ComponentSet& set);
    void removeSet(Entity entity, const ComponentSet& set);
    Place move(Entity entity, Archetype& to);
    void takeRowOut(Archetype& archetype, uint32_t row);
    void destroyLeaf(Entity entity);
    void attachOrFail(Entity child, Entity parent);
    template <class T>
    static void store(const Place& place, const T& value);
    template <class T>
    [[nodiscard]] T* find(Entity entity, Stamp stamp) const;
    template <class T>
    void setStamped(Entity entity, const T& value, Stamp stamp) const;
    template <class T>
    [[nodiscard]] Entity singletonEntity() const;

    EntityTable m_entities;
    std::vector<std::unique_ptr<Archetype>> m_archetypes; // in the order they were made; 0 is empty
    std::unordered_map<ComponentMask, Archetype*, ComponentMask::Hash> m_byMask;
    std::vector<Archetype*> m_bySet; // [ComponentSet::slot]
    Hierarchy m_hierarchy;
    std::vector<Entity> m_singletons;   // [ComponentId]
    std::vector<Entity> m_doomed;       // scratch of destroy()
    std::vector<uint32_t> m_mergeSlots; // scratch of command playback
    Stamp m_stamp{1, 0};
    bool m_inSystems = false;

    mutable std::mutex m_queryMutex;                            // systems make queries at once
    mutable std::vector<std::unique_ptr<QueryCache>> m_queries; // [query slot]
    mutable std::atomic<uint32_t> m_iterating = 0;
};

} // namespace penumbra::ecs

#include "runtime/ecs/world_impl.h"
