// The templates of world.h, which includes this file.
#pragma once

#include "runtime/assert.h"
#include "runtime/ecs/world.h"

namespace penumbra::ecs {

inline void World::assertStructural([[maybe_unused]] Entity entity) const
{
    PENUMBRA_DEBUG_ASSERT(!m_inSystems, "structural change{} in {}: use context.commands()",
                          ofEntity(entity), currentSystem());
    PENUMBRA_DEBUG_ASSERT(m_iterating == 0,
                          "structural change{} during {} iteration(s): use a CommandBuffer",
                          ofEntity(entity), m_iterating.load());
    PENUMBRA_DEBUG_ASSERT(!isTelling(), "structural change{} in an observer: use its commands",
                          ofEntity(entity));
}

inline void World::assertOutsideSystems() const
{
    PENUMBRA_DEBUG_ASSERT(!m_inSystems, "World used inside a system ({}): go through SystemContext",
                          currentSystem());
}

// createMany() arguments: T repeats one value, std::span<const T> gives one each.
template <class T>
struct BulkArgument {
    using Component = T;
    static const void* values(const T& value, size_t) { return &value; }
    static constexpr size_t kStride = 0;
};
template <class T, size_t kExtent>
struct BulkArgument<std::span<T, kExtent>> {
    using Component = std::remove_const_t<T>;
    static const void* values(std::span<T, kExtent> values, size_t count)
    {
        PENUMBRA_ASSERT(values.size() == count, "{} values of {} for {} entities", values.size(),
                        ComponentTraits<Component>::kName, count);
        return values.data();
    }
    static constexpr size_t kStride = sizeof(T);
};

template <class T>
void World::store(const Place& place, [[maybe_unused]] const T& value)
{
    if constexpr (!kIsTag<T>) {
        const int32_t column = place.archetype->columnOf(componentId<T>());
        for (uint32_t lane = 0; lane < kLaneCount<T>; ++lane)
            std::memcpy(place.archetype->at(column + lane, place.row),
                        reinterpret_cast<const std::byte*>(&value) + lane * sizeof(Lane<T>),
                        sizeof(Lane<T>));
    }
}

template <class... Ts>
Entity World::create(const Ts&... values)
{
    const Place place = createIn(componentSet<Ts...>());
    const Entity entity = place.archetype->entities()[place.row];
    (store(place, values), ...);
    if constexpr ((std::is_same_v<Ts, Parent> || ...))
        attachOrFail(entity, std::get<const Parent&>(std::tie(values...)).entity);
    if (m_observers != nullptr) [[unlikely]]
        tellGiven({&entity, 1}, {}, componentSet<Ts...>().mask);
    return entity;
}

template <class... Arguments>
void World::createMany(std::span<Entity> out, const Arguments&... arguments)
{
    const auto count = static_cast<uint32_t>(out.size());
    Archetype& archetype =
        createManyIn(componentSet<typename BulkArgument<Arguments>::Component...>(), out);
    const uint32_t row = archetype.count() - count;
    (archetype.fill(componentId<typename BulkArgument<Arguments>::Component>(), row, count,
                    BulkArgument<Arguments>::values(arguments, count),
                    BulkArgument<Arguments>::kStride),
     ...);
    if constexpr ((std::is_same_v<typename BulkArgument<Arguments>::Component, Parent> || ...))
        for (const Entity entity : out)
            attachOrFail(entity, value<Parent>(entity).entity);
    if (m_observers != nullptr) [[unlikely]]
        tellGiven(out, {}, archetype.mask());
}

template <class... Ts>
void World::add(Entity entity, const Ts&... values)
{
    if constexpr ((std::is_same_v<Ts, Parent> || ...))
        attachOrFail(entity, std::get<const Parent&>(std::tie(values...)).entity);
    ComponentMask before;
    if (m_observers != nullptr) [[unlikely]]
        before = components(entity);
    const Place place = addSet(entity, componentSet<Ts...>());
    (store(place, values), ...);
    if (m_observers != nullptr) [[unlikely]]
        tellGiven({&entity, 1}, before, componentSet<Ts...>().mask);
}

template <class T>
void World::set(Entity entity, const T& value)
{
    assertOutsideSystems();
    setStamped(entity, value, m_stamp);
    if (m_observers != nullptr) [[unlikely]] {
        const ComponentMask& mask = componentSet<T>().mask;
        tellGiven({&entity, 1}, mask, mask);
    }
}

template <class T>
void World::setStamped(Entity entity, const T& value, Stamp stamp) const
{
    static_assert(!std::is_same_v<T, Parent>, "setParent() changes parents");
    static_assert(!kIsTag<T>, "a tag has no value");
    const Place at = place(entity);
    const int32_t column = at.archetype->columnOf(componentId<T>());
    if (column < 0) [[unlikely]]
        failMissing(entity, componentId<T>());
    at.archetype->markRow(column, at.row, stamp);
    store(at, value);
}

template <class... Ts>
void World::remove(Entity entity)
{
    removeSet(entity, componentSet<Ts...>());
}

template <class T>
bool World::has(Entity entity) const
{
    return place(entity).archetype->mask().test(componentId<T>());
}

template <class T>
T* World::find(Entity entity, Stamp stamp) const
{
    using Component = std::remove_const_t<T>;
    static_assert(!kIsTag<Component>, "a tag has no value: has()");
    static_assert(kLaneCount<Component> == 1,
                  "split into lanes, it has no address: value(), set()");
    static_assert(std::is_const_v<T> || !std::is_same_v<T, Parent>, "setParent() changes parents");
    const Place at = place(entity);
    const int32_t column = at.archetype->columnOf(componentId<Component>());
    if (column < 0)
        return nullptr;
    if constexpr (!std::is_const_v<T>)
        at.archetype->markRow(column, at.row, stamp);
    return reinterpret_cast<T*>(at.archetype->at(column, at.row));
}

template <class T>
T* World::tryGet(Entity entity)
{
    assertOutsideSystems();
    return find<T>(entity, m_stamp);
}

template <class T>
const T* World::tryGet(Entity entity) const
{
    assertOutsideSystems();
    return find<const T>(entity, m_stamp);
}

template <class T>
T& World::get(Entity entity)
{
    T* value = tryGet<T>(entity);
    if (value == nullptr) [[unlikely]]
        failMissing(entity, componentId<std::remove_const_t<T>>());
    return *value;
}

template <class T>
const T& World::get(Entity entity) const
{
    const T* value = tryGet<T>(entity);
    if (value == nullptr) [[unlikely]]
        failMissing(entity, componentId<std::remove_const_t<T>>());
    return *value;
}

template <class T>
T World::value(Entity entity) const
{
    const Place at = place(entity);
    if (at.archetype->columnOf(componentId<T>()) < 0) [[unlikely]]
        failMissing(entity, componentId<T>());
    T result;
    at.archetype->read(componentId<T>(), at.row, &result);
    return result;
}

template <class T>
bool World::hasSingleton() const
{
    const ComponentId id = componentId<T>();
    return id < m_singletons.size() && alive(m_singletons[id]);
}

template <class T>
Entity World::setSingleton(const T& value)
{
    const ComponentId id = componentId<T>();
    if (hasSingleton<T>()) {
        set(m_singletons[id], value);
        return m_singletons[id];
    }
    if (id >= m_singletons.size())
        m_singletons.resize(id + 1);
    return m_singletons[id] = create(value);
}

template <class T>
Entity World::singletonEntity() const
{
    const ComponentId id = componentId<T>();
    PENUMBRA_ASSERT(hasSingleton<T>(), "no singleton {} in this world", componentInfo(id).name);
    return m_singletons[id];
}

template <class T>
T& World::singleton()
{
    return get<T>(singletonEntity<std::remove_const_t<T>>());
}

template <class T>
const T& World::singleton() const
{
    return get<const T>(singletonEntity<std::remove_const_t<T>>());
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
