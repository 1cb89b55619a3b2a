// The templates of world.h, which includes this file: structure. Values: world_values.h.
#pragma once

#include "runtime/ecs/query_down.h"
#include "runtime/ecs/world.h"

namespace penumbra::ecs {

inline void World::assertStructural([[maybe_unused]] Entity entity) const
{
#ifndef NDEBUG
    if (m_inSystems || __atomic_load_n(&m_iterating, __ATOMIC_RELAXED) != 0 || isTelling())
        [[unlikely]]
        failStructural(entity);
#endif
}

inline void World::assertOutsideSystems() const
{
#ifndef NDEBUG
    if (m_inSystems) [[unlikely]]
        failInSystem();
#endif
}

[[noreturn]] void failBulkCount(std::string_view component, size_t values, size_t entities);

// createMany() arguments: T repeats one value, std::span<const T> gives one each.
template <class T>
struct BulkArgument {
    using Component = T;
    static const void* values(const T& value, size_t) { return &value; }
    static const void* at(const T& value, size_t) { return &value; }
    static const T& one(const T& value, size_t) { return value; }
    static constexpr size_t kStride = 0;
};
template <class T, size_t kExtent>
struct BulkArgument<std::span<T, kExtent>> {
    using Component = std::remove_const_t<T>;
    static const void* values(std::span<T, kExtent> values, size_t count)
    {
        if (values.size() != count) [[unlikely]]
            failBulkCount(ComponentTraits<Component>::kName, values.size(), count);
        return values.data();
    }
    static const void* at(std::span<T, kExtent> values, size_t i) { return values.data() + i; }
    static const T& one(std::span<T, kExtent> values, size_t i) { return values[i]; }
    static constexpr size_t kStride = sizeof(T);
};

// Inline: a row is written in less time than a call through here takes.
inline World::NewRow World::createIn(const ComponentSet& set)
{
    assertStructural();
    if (set.slot >= m_bySet.size() || m_bySet[set.slot] == nullptr) [[unlikely]]
        return createOutsideWindow(set);
    Archetype& archetype = *m_bySet[set.slot];
    const Archetype::Window& window = archetype.window;
    const uint32_t row = archetype.count();
    if (row - window.first >= window.rows || window.version != m_stamp.version) [[unlikely]]
        return createOutsideWindow(set);
    const Entity entity = m_entities.allocateAt(window.rowPlace + row);
    archetype.push(entity);
    return {window.columns, archetype.rowInBlock(row), entity};
}

// A value on its way into a row, as a copy: the caller's may lie in this world, in a row that is
// about to move. Copying may throw, what follows may not.
template <class T>
struct Incoming {
    T value;

    // `over`: the row holds a value already.
    void store(const Archetype::RowPlace& place, [[maybe_unused]] bool over)
    {
        if constexpr (!kIsTag<T>) // known since the archetype was looked for
            storeAt(place.columns + place.columnOf[kKnownId<T> - 1], place.row, over);
    }
    // At a row of the block whose columns these are, from the component's first on.
    void storeAt([[maybe_unused]] std::byte* const* columns, [[maybe_unused]] size_t row,
                 [[maybe_unused]] bool over)
    {
        if constexpr (kIsTag<T>) {
        } else if constexpr (kIsPlain<T>) {
            using Lanes = std::array<Lane<T>, kLaneCount<T>>;
            const Lanes lanes = std::bit_cast<Lanes>(value);
            for (size_t lane = 0; lane < lanes.size(); ++lane)
                new (columns[lane] + row * sizeof(Lane<T>)) Lane<T>(lanes[lane]);
        } else {
            T* at = reinterpret_cast<T*>(columns[0]) + row;
            if (over)
                at->~T();
            new (at) T(static_cast<T&&>(value));
        }
    }
};

template <class... Ts>
Entity parentIn(const Ts&... values) // null: none of them is a Parent
{
    Entity parent;
    [[maybe_unused]] const auto look = [&](const auto& value) {
        if constexpr (std::is_same_v<decltype(value), const Parent&>)
            parent = value.entity;
    };
    (look(values), ...);
    return parent;
}

template <class... Ts>
Entity World::create(Ts&&... values)
{
    std::tuple<Incoming<std::remove_cvref_t<Ts>>...> incoming{
        Incoming<std::remove_cvref_t<Ts>>{std::forward<Ts>(values)}...};
    constexpr bool kHasParent = (std::is_same_v<std::remove_cvref_t<Ts>, Parent> || ...);
    if constexpr (kHasParent)
        checkParent({}, parentIn(values...));
    const ComponentSet& set = componentSet<std::remove_cvref_t<Ts>...>();
    const NewRow made = createIn(set);
    (std::get<Incoming<std::remove_cvref_t<Ts>>>(incoming).storeAt(
         made.columns + firstColumnAmong<std::remove_cvref_t<Ts>, std::remove_cvref_t<Ts>...>(),
         made.row, false),
     ...);
    if constexpr (kHasParent)
        attachOrFail(made.entity, parentIn(values...));
    if (m_observers != nullptr) [[unlikely]]
        tellCreated(made.entity, set.mask);
    return made.entity;
}

template <class... Arguments>
void World::createMany(std::span<Entity> out, const Arguments&... arguments)
{
    const auto count = static_cast<uint32_t>(out.size());
    Archetype& archetype =
        roomFor(componentSet<typename BulkArgument<Arguments>::Component...>(), count);
    const uint32_t row = archetype.count();
    fillAll(archetype, row, count, arguments...);
    appendNew(archetype, out);
    if constexpr ((std::is_same_v<typename BulkArgument<Arguments>::Component, Parent> || ...))
        for (const Entity entity : out)
            attachOrFail(entity, value<Parent>(entity).entity);
    if (m_observers != nullptr) [[unlikely]]
        tellGiven(out, {}, archetype.mask());
}

// Values for the rows, which are within room and hold none. If a copy throws, none is left.
template <class... Arguments>
void World::fillAll(Archetype& archetype, [[maybe_unused]] uint32_t row,
                    [[maybe_unused]] uint32_t count, const Arguments&... arguments)
{
    [[maybe_unused]] size_t filled = 0;
    [[maybe_unused]] const auto fill = [&]<class Argument>(const Argument& argument) {
        archetype.fill(componentId<typename BulkArgument<Argument>::Component>(), row, count,
                       BulkArgument<Argument>::values(argument, count),
                       BulkArgument<Argument>::kStride);
        ++filled;
    };
    if constexpr ((kIsPlain<typename BulkArgument<Arguments>::Component> && ...)) {
        (fill(arguments), ...);
    } else {
        try {
            (fill(arguments), ...);
        } catch (...) {
            size_t i = 0;
            const auto undo = [&]<class Component>() {
                if constexpr (!kIsPlain<Component> && !kIsTag<Component>)
                    if (i < filled)
                        archetype.destroyValues(componentId<Component>(), row, count);
                ++i;
            };
            (undo.template operator()<typename BulkArgument<Arguments>::Component>(), ...);
            throw;
        }
    }
}

template <class... Ts>
void World::add(Entity entity, Ts&&... values)
{
    std::tuple<Incoming<std::remove_cvref_t<Ts>>...> incoming{
        Incoming<std::remove_cvref_t<Ts>>{std::forward<Ts>(values)}...};
    constexpr bool kHasParent = (std::is_same_v<std::remove_cvref_t<Ts>, Parent> || ...);
    if constexpr (kHasParent)
        checkParent(entity, parentIn(values...));
    [[maybe_unused]] const ComponentMask before = place(entity).archetype->mask();
    const ComponentSet& set = componentSet<std::remove_cvref_t<Ts>...>();
    const Place place = addSet(entity, set);
    if constexpr (sizeof...(Ts) > 0) {
        const Archetype::RowPlace row = place.archetype->rowPlace(place.row);
        (std::get<Incoming<std::remove_cvref_t<Ts>>>(incoming).store(
             row, !kIsPlain<std::remove_cvref_t<Ts>> &&
                      before.test(componentId<std::remove_cvref_t<Ts>>())),
         ...);
    }
    if constexpr (kHasParent)
        attachOrFail(entity, parentIn(values...));
    if (m_observers != nullptr) [[unlikely]]
        tellGiven({&entity, 1}, before, set.mask);
}

template <class... Arguments>
void World::addMany(std::span<const Entity> entities, const Arguments&... arguments)
{
    static_assert((!std::is_same_v<typename BulkArgument<Arguments>::Component, Parent> && ...),
                  "parents go one by one: setParent()");
    assertStructural();
    (static_cast<void>(BulkArgument<Arguments>::values(arguments, entities.size())), ...);
    const ComponentSet& set = componentSet<typename BulkArgument<Arguments>::Component...>();
    ObserversWait observers(*this);
    for (size_t done = 0; done < entities.size();) {
        const size_t length = runLength(entities.subspan(done));
        const auto run = entities.subspan(done, length);
        Archetype& from = *place(run[0]).archetype;
        Archetype& to = withSet(from, set);
        const bool plainAndNew =
            (kIsPlain<typename BulkArgument<Arguments>::Component> && ...) && &to != &from;
        if (plainAndNew) {
            const uint32_t row = moveRun(run, from, to);
            (to.fill(componentId<typename BulkArgument<Arguments>::Component>(), row,
                     static_cast<uint32_t>(length), BulkArgument<Arguments>::at(arguments, done),
                     BulkArgument<Arguments>::kStride),
             ...);
            if (m_observers != nullptr) [[unlikely]]
                tellGiven(run, from.mask(), set.mask);
        } else {
            for (size_t i = 0; i < length; ++i)
                add(run[i], BulkArgument<Arguments>::one(arguments, done + i)...);
        }
        done += length;
    }
    observers.finish();
}

template <class... Ts>
void World::removeMany(std::span<const Entity> entities)
{
    static_assert((!std::is_same_v<Ts, Parent> && ...), "parents go one by one: clearParent()");
    assertStructural();
    const ComponentSet& set = componentSet<Ts...>();
    ObserversWait observers(*this);
    for (size_t done = 0; done < entities.size();) {
        const auto run = entities.subspan(done, runLength(entities.subspan(done)));
        Archetype& from = *place(run[0]).archetype;
        if (Archetype& to = withoutSet(from, set); &to != &from) {
            if (m_observers != nullptr) [[unlikely]]
                tellRemoved(run, set.mask);
            moveRun(run, from, to);
        }
        done += run.size();
    }
    observers.finish();
}

template <class... Ts>
void World::remove(Entity entity)
{
    removeSet(entity, componentSet<Ts...>());
}

inline const QueryCache& World::cacheOf(uint32_t querySlot) const
{
    if (QueryCache* const* const page =
            __atomic_load_n(&m_queryPages[querySlot / kQueriesPerPage], __ATOMIC_ACQUIRE))
        if (const QueryCache* cache =
                __atomic_load_n(&page[querySlot % kQueriesPerPage], __ATOMIC_ACQUIRE))
            if (cache->isCurrent(m_archetypes.size())) [[likely]]
                return *cache;
    return findCache(querySlot);
}

template <class... Terms>
Query<Terms...> World::query()
{
    assertOutsideSystems();
    return {cacheOf(Query<Terms...>::slot()), m_stamp, 0, m_iterating};
}

template <class... Terms>
requires(Query<Terms...>::kReadOnly) Query<Terms...> World::query()
const
{
    assertOutsideSystems();
    return {cacheOf(Query<Terms...>::slot()), m_stamp, 0, m_iterating};
}

} // namespace penumbra::ecs
