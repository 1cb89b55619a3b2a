// The templates of world.h, which includes this file: values of components, singletons.
#pragma once

#include "runtime/ecs/world_impl.h"

namespace penumbra::ecs {

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
    Incoming<T> incoming{value};
    at.archetype->markRow(column, at.row, stamp);
    incoming.store(at.archetype->rowPlace(at.row), true);
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
    // What is rare is a call at the end: calls in the middle make the way past them longer too.
    const uint32_t known = __atomic_load_n(&kKnownId<Component>, __ATOMIC_RELAXED);
    if (known == 0) [[unlikely]]
        return findUnknown<T>(entity, stamp);
    const Place at = place(entity);
    const int32_t column = at.archetype->columnOf(static_cast<ComponentId>(known - 1));
    if (column < 0)
        return nullptr;
    if constexpr (!std::is_const_v<T>)
        if (!at.archetype->template markAgain<ComponentTraits<Component>::kRowChanges>(
                column, at.row, stamp)) [[unlikely]]
            return findFirst<T>(at, column, stamp);
    return valueAt<T>(at, column);
}

template <class T>
[[gnu::noinline, gnu::cold]] T* World::findUnknown(Entity entity, Stamp stamp) const
{
    static_cast<void>(componentId<std::remove_const_t<T>>());
    return find<T>(entity, stamp);
}

template <class T>
[[gnu::noinline]] T* World::findFirst(Place at, uint32_t column, Stamp stamp)
{
    at.archetype->markRow(column, at.row, stamp);
    return valueAt<T>(at, column);
}

template <class T>
T* World::valueAt(const Place& at, uint32_t column)
{
    return reinterpret_cast<T*>(at.archetype->columnsAt(at.row)[column]) +
           at.archetype->rowInBlock(at.row);
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
    if constexpr (kIsPlain<T>) {
        T result;
        at.archetype->read(componentId<T>(), at.row, &result);
        return result;
    } else {
        return *find<const T>(entity, {});
    }
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
    if (!hasSingleton<T>()) [[unlikely]]
        failNoSingleton(id);
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

} // namespace penumbra::ecs
