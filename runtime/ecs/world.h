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

namespace penumbra::ecs {

struct ArchetypeStatistics {
    ComponentMask components;
    uint32_t rows = 0, disabledRows = 0, segments = 0;
    size_t valueBytes = 0, blockBytes = 0, bookBytes = 0; // as below
};

struct WorldStatistics {
    uint32_t entities = 0, disabled = 0, archetypes = 0, segments = 0;
    size_t valueBytes = 0; // of living components
    size_t blockBytes = 0; // allocated for them
    size_t bookBytes = 0;  // ids, versions, change bits, entity table, hierarchy, query caches
    std::vector<ArchetypeStatistics> perArchetype; // in the order they were made
};
// A table: totals, then a line per archetype; in KiB.
[[nodiscard]] std::string toString(const WorldStatistics& statistics);

class DestroyedLog;
class ObserverTable;

class World {
public:
    World();
    ~World();
    World(const World&) = delete;
    World& operator=(const World&) = delete;

    // Where memory runs out or copying or making a value throws, the exception passes through and
    // the world is as it was (…Many: addMany has done the entities before; the rest as one).

    // --- Entities. All components arrive in one move.
    template <class... Ts>
    Entity create(Ts&&... values);
    // out.size() entities. Each argument is one value for all of them, a std::span<const T> of
    // out.size() values, or a function that makes the value of place i, T(uint32_t i), and leaves
    // the world as it is.
    template <class... Arguments>
    void createMany(std::span<Entity> out, const Arguments&... arguments);
    // With everything below it in the hierarchy.
    void destroy(Entity entity);
    // All alive and, for that, distinct; entities below others in the list are fine.
    void destroyMany(std::span<const Entity> entities);
    [[nodiscard]] bool alive(Entity entity) const { return m_entities.alive(entity); }
    [[nodiscard]] uint32_t count() const { return m_entities.count(); }

    // --- Enabled or not. Queries skip disabled entities (but for WithDisabled); all else works on
    // them as before, and nothing moves. Per entity: what is below a disabled one stays as it is,
    // unless the reach says otherwise, and what is attached later is enabled. Enabling counts as a
    // change of all components.
    void setEnabled(Entity entity, bool enabled, Reach reach = Reach::entity);
    [[nodiscard]] bool isEnabled(Entity entity) const;

    // --- Components. add overwrites what is there; set needs it there; remove ignores absence.
    template <class... Ts>
    void add(Entity entity, Ts&&... values);
    template <class T>
    void set(Entity entity, const T& value);
    template <class... Ts>
    void remove(Entity entity);
    // The same for all entities of a list, faster: those that lie in one archetype one after the
    // other in the list move together. All alive and distinct; arguments as of createMany(),
    // functions noexcept if they are to be as fast. Not for Parent.
    template <class... Arguments>
    void addMany(std::span<const Entity> entities, const Arguments&... arguments);
    template <class... Ts>
    void removeMany(std::span<const Entity> entities);
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
    void clearParent(Entity child);
    [[nodiscard]] const Hierarchy& hierarchy();

    // --- Versions. Writes are stamped with version(); to look for changes, keep version(), then
    // advance(), and later ask for what was written since.
    [[nodiscard]] uint64_t version() const { return m_stamp.version; }
    void advance();

    // --- Looking inside. What is called and shown how is up to debug_hooks.h as well.
    // "12#3 'ball'"; the name only if it has one. Any entity may be asked about.
    [[nodiscard]] std::string describe(Entity entity) const;
    // What it is, its place in the hierarchy, and one line per component: name, bytes, version,
    // value.
    [[nodiscard]] std::string dump(Entity entity) const;
    [[nodiscard]] WorldStatistics statistics() const;
    [[nodiscard]] ComponentMask components(Entity entity) const;
    // Messages about a stale Entity then tell what it was. On in debug builds.
    void rememberDestroyed(bool remember);
    void trim(); // gives back memory that holds no rows; else it is kept for the next ones

private:
    friend class SystemContext;
    friend class Schedule;
    friend class CommandPlayback;
    friend class ObserverTable;
    friend class WorldAccess;

    [[nodiscard]] Place place(Entity entity) const
    {
        if (!m_entities.alive(entity)) [[unlikely]]
            failStale(entity);
        return m_entities.place(entity);
    }
    [[noreturn]] void failStale(Entity entity) const;
    [[noreturn]] void failMissing(Entity entity, ComponentId id) const;
    [[noreturn]] void failStructural(Entity entity) const;
    [[noreturn]] void failAdvance() const;
    [[noreturn]] static void failInSystem();
    [[noreturn]] static void failNoSingleton(ComponentId id);
    void assertStructural(Entity entity = {}) const;
    void assertOutsideSystems() const;
    [[nodiscard]] std::string ofEntity(Entity entity) const; // " of 12#3 'ball'"; null: ""
    [[nodiscard]] static std::string currentSystem();        // of this thread: "system 'move'"
    [[nodiscard]] std::string nameOf(Entity entity) const;   // empty: none

    [[nodiscard]] Archetype& archetypeOf(const ComponentMask& mask);
    [[nodiscard]] Archetype& archetypeOf(const ComponentSet& set)
    {
        if (set.slot < m_bySet.size() && m_bySet[set.slot] != nullptr) [[likely]]
            return *m_bySet[set.slot];
        return findArchetype(set);
    }
    Archetype& findArchetype(const ComponentSet& set);
    template <class AnyQuery>
    [[nodiscard]] const QueryCache& cacheOf() const;
    [[nodiscard]] const QueryCache& findCache(uint32_t querySlot) const;
    void dropQueries();
    // Room for `more` rows. After it, nothing throws that puts rows in.
    void makeRoom(Archetype& archetype, uint32_t more)
    {
        if (!archetype.hasRoom(more)) [[unlikely]]
            growRoom(archetype, more);
    }
    void growRoom(Archetype& archetype, uint32_t more);
    void setPlaces(Archetype& archetype, uint32_t row);
    struct NewRow {
        std::byte* const* columns; // of its block
        size_t row;                // within the block
        Entity entity;
    };
    NewRow createIn(const ComponentSet& set);
    NewRow createOutsideWindow(const ComponentSet& set);
    Archetype& roomFor(const ComponentSet& set, size_t count);
    void appendNew(Archetype& archetype, std::span<Entity> out);
    [[nodiscard]] Archetype& withSet(Archetype& from, const ComponentSet& set);
    [[nodiscard]] Archetype& withoutSet(Archetype& from, const ComponentSet& set);
    Place addSet(Entity entity, const ComponentSet& set);
    void removeSet(Entity entity, const ComponentSet& set);
    Place move(Entity entity, const Place& from, Archetype& to);
    // Rows of one archetype, distinct, move to another. Returns the first new row.
    uint32_t moveRun(std::span<const Entity> entities, Archetype& from, Archetype& to);
    // The first entities of the list that lie in one archetype.
    [[nodiscard]] size_t runLength(std::span<const Entity> entities) const;
    void takeRowOut(Archetype& archetype, uint32_t row);
    void closeGap(Archetype& archetype, uint32_t row);
    void destroyLeaf(Entity entity);
    void checkParent(Entity child, Entity parent);
    void destroyTree(Entity entity);
    void destroyListed(std::span<const Entity> entities);
    void destroyWatched(std::span<const Entity> entities);
    [[nodiscard]] bool isWatched() const // destroy() has more to do than to destroy
    {
        return m_observers != nullptr || m_destroyed != nullptr;
    }
    // For observers; the entities lie in one archetype. `given` components came, or were set if
    // they were there `before`; `removed` ones are about to go.
    void tellGiven(std::span<const Entity> entities, const ComponentMask& before,
                   const ComponentMask& given);
    void tellCreated(Entity entity, const ComponentMask& given) // by value: none has an address
    {
        tellGiven({&entity, 1}, {}, given);
    }
    void tellRemoved(std::span<const Entity> entities, const ComponentMask& removed);
    void settleObservers();
    [[nodiscard]] bool isTelling() const;
    // Around an operation made of others: observers' commands wait until finish(). Where an
    // exception passes, they wait for the next operation.
    class ObserversWait {
    public:
        explicit ObserversWait(World& world) : m_table(world.m_observers)
        {
            if (m_table != nullptr) [[unlikely]]
                enter();
        }
        ~ObserversWait()
        {
            if (m_table != nullptr) [[unlikely]]
                leave(false);
        }
        ObserversWait(const ObserversWait&) = delete;
        ObserversWait& operator=(const ObserversWait&) = delete;
        void finish()
        {
            if (m_table != nullptr) [[unlikely]]
                leave(true);
        }

    private:
        void enter();
        void leave(bool settle);
        ObserverTable* m_table; // null: nobody, or left
    };
    void attachOrFail(Entity child, Entity parent);
    template <class... Arguments>
    static void fillAll(Archetype& archetype, uint32_t row, uint32_t count,
                        const Arguments&... arguments);
    template <class T>
    [[nodiscard]] T* find(Entity entity, Stamp stamp) const;
    template <class T>
    [[nodiscard]] T* findUnknown(Entity entity, Stamp stamp) const;
    template <class T>
    [[nodiscard]] static T* findFirst(Place at, uint32_t column, Stamp stamp);
    template <class T>
    [[nodiscard]] static T* valueAt(const Place& at, uint32_t column);
    template <class T>
    void setStamped(Entity entity, const T& value, Stamp stamp) const;
    template <class T>
    [[nodiscard]] Entity singletonEntity() const;

    struct Index; // archetypes by their components, queries, a lock: what needs heavy headers

    EntityTable m_entities;
    std::vector<Archetype*> m_archetypes; // owned, in the order they were made; 0 is empty
    Index* m_index;                       // owned
    std::vector<Archetype*> m_bySet;      // [ComponentSet::slot]
    Hierarchy m_hierarchy;
    std::vector<Entity> m_singletons;   // [ComponentId]
    std::vector<Entity> m_doomed;       // scratch of destroy()
    std::vector<uint32_t> m_mergeSlots; // scratch of command playback
    std::vector<uint32_t> m_leaving;    // scratch of moveRun()
    Stamp m_stamp{1, 0};
    bool m_inSystems = false;
    ObserverTable* m_observers = nullptr; // owned; null before the first observer
    DestroyedLog* m_destroyed = nullptr;  // owned; null: not wanted

    mutable uint32_t m_iterating = 0; // debug builds; several threads count
    // By slot, in pages that never move: systems look their queries up without a lock.
    mutable std::array<const QueryPage*, kMaxQueries / QueryPage::kSlots> m_queryPages;
};

} // namespace penumbra::ecs

#include "runtime/ecs/world_values.h"
