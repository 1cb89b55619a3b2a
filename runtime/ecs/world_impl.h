// The templates of world.h, which includes this file: structure. Values: world_values.h.
#pragma once

#include "runtime/ecs/query_down.h"
#include "runtime/ecs/world.h"

#include <algorithm>

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

inline void World::advance()
{
#ifndef NDEBUG
    if (__atomic_load_n(&m_iterating, __ATOMIC_RELAXED) != 0) [[unlikely]]
        failAdvance();
#endif
    m_stamp = {m_stamp.version + 1, m_stamp.version};
}

[[noreturn]] void failBulkCount(std::string_view component, size_t values, size_t entities);

// Constructs value(first), value(first + 1), … in the rows, which are within room. If one throws,
// none is left.
template <class T, class Function>
void fillFrom(Archetype& archetype, uint32_t row, uint32_t count, const Function& value,
              uint32_t first)
{
    const ComponentId id = componentId<T>();
    const auto column = static_cast<uint32_t>(archetype.columnOf(id));
    for (uint32_t done = 0; done < count;) {
        const uint32_t at = row + done;
        const auto inBlock = static_cast<uint32_t>(archetype.rowInBlock(at));
        const uint32_t length = std::min(archetype.blockRows() - inBlock, count - done);
        if constexpr (kIsPlain<T>) {
            using Lanes = std::array<Lane<T>, kLaneCount<T>>;
            std::array<Lane<T>*, kLaneCount<T>> to;
            for (uint32_t lane = 0; lane < to.size(); ++lane)
                to[lane] = reinterpret_cast<Lane<T>*>(archetype.at(column + lane, at));
            for (uint32_t i = 0; i < length; ++i) {
                const Lanes lanes = std::bit_cast<Lanes>(T(value(first + done + i)));
                for (uint32_t lane = 0; lane < to.size(); ++lane)
                    new (to[lane] + i) Lane<T>(lanes[lane]);
            }
        } else {
            T* const to = reinterpret_cast<T*>(archetype.at(column, at));
            uint32_t made = 0;
            try {
                for (; made < length; ++made)
                    new (to + made) T(value(first + done + made));
            } catch (...) {
                archetype.destroyValues(id, row, done + made);
                throw;
            }
        }
        done += length;
    }
}

// No component: those have a name, and one that can be called stays a value.
template <class T>
inline constexpr bool kMakesValues = std::is_invocable_v<const T&, uint32_t> && !requires
{
    T::kName;
};

// createMany() arguments: T repeats one value, std::span<const T> gives one each, and so does a
// function of the place in the list.
template <class T>
struct BulkArgument {
    using Component = T;
    static constexpr bool kFails = false; // to tell the values, but for copies of them
    static void check(const T&, size_t) {}
    // Rows [row, row + count), from the value of place `first` on.
    static void fill(Archetype& archetype, uint32_t row, uint32_t count, const T& value, uint32_t)
    {
        archetype.fill(componentId<T>(), row, count, &value, 0);
    }
    static const T& one(const T& value, uint32_t) { return value; }
};
template <class T, size_t kExtent>
struct BulkArgument<std::span<T, kExtent>> {
    using Component = std::remove_const_t<T>;
    static constexpr bool kFails = false;
    static void check(std::span<T, kExtent> values, size_t count)
    {
        if (values.size() != count) [[unlikely]]
            failBulkCount(ComponentTraits<Component>::kName, values.size(), count);
    }
    static void fill(Archetype& archetype, uint32_t row, uint32_t count,
                     std::span<T, kExtent> values, uint32_t first)
    {
        archetype.fill(componentId<Component>(), row, count, values.data() + first, sizeof(T));
    }
    static const T& one(std::span<T, kExtent> values, uint32_t i) { return values[i]; }
};
template <class T>
requires kMakesValues<T>
struct BulkArgument<T> {
    using Component = std::remove_cvref_t<std::invoke_result_t<const T&, uint32_t>>;
    static constexpr bool kFails = !std::is_nothrow_invocable_v<const T&, uint32_t>;
    static void check(const T&, size_t) {}
    static void fill(Archetype& archetype, uint32_t row, uint32_t count, const T& value,
                     uint32_t first)
    {
        if constexpr (!kIsTag<Component>)
            fillFrom<Component>(archetype, row, count, value, first);
    }
    static Component one(const T& value, uint32_t i) { return value(i); }
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
    (BulkArgument<Arguments>::check(arguments, count), ...);
    Archetype& archetype =
        roomFor(componentSet<typename BulkArgument<Arguments>::Component...>(), count);
    const uint32_t row = archetype.count();
    {
        const IterationGuard guard(m_iterating); // functions must leave the world as it is
        fillAll(archetype, row, count, arguments...);
    }
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
        BulkArgument<Argument>::fill(archetype, row, count, argument, 0);
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
    (BulkArgument<Arguments>::check(arguments, entities.size()), ...);
    const ComponentSet& set = componentSet<typename BulkArgument<Arguments>::Component...>();
    ObserversWait observers(*this);
    for (size_t done = 0; done < entities.size();) {
        const size_t length = runLength(entities.subspan(done));
        const auto run = entities.subspan(done, length);
        Archetype& from = *place(run[0]).archetype;
        Archetype& to = withSet(from, set);
        // Once moved, a run has to get its values.
        constexpr bool kCannotFail = ((kIsPlain<typename BulkArgument<Arguments>::Component> &&
                                       !BulkArgument<Arguments>::kFails) &&
                                      ...);
        if (kCannotFail && &to != &from) {
            const uint32_t row = moveRun(run, from, to);
            (BulkArgument<Arguments>::fill(to, row, static_cast<uint32_t>(length), arguments,
                                           static_cast<uint32_t>(done)),
             ...);
            if (m_observers != nullptr) [[unlikely]]
                tellGiven(run, from.mask(), set.mask);
        } else {
            for (size_t i = 0; i < length; ++i)
                add(run[i],
                    BulkArgument<Arguments>::one(arguments, static_cast<uint32_t>(done + i))...);
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

template <class AnyQuery>
const QueryCache& World::cacheOf() const
{
    const uint32_t slot = AnyQuery::knownSlot();
    const QueryPage& page =
        *__atomic_load_n(&m_queryPages[slot / QueryPage::kSlots], __ATOMIC_ACQUIRE);
    if (const QueryCache* cache =
            __atomic_load_n(&page.current[slot % QueryPage::kSlots], __ATOMIC_ACQUIRE)) [[likely]]
        return *cache;
    return findCache(AnyQuery::findSlot());
}

template <class... Terms>
Query<Terms...> World::query()
{
    assertOutsideSystems();
    return {cacheOf<Query<Terms...>>(), m_stamp, 0, m_iterating};
}

template <class... Terms>
requires(Query<Terms...>::kReadOnly) Query<Terms...> World::query()
const
{
    assertOutsideSystems();
    return {cacheOf<Query<Terms...>>(), m_stamp, 0, m_iterating};
}

} // namespace penumbra::ecs
