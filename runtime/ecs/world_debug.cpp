// World: the words of its messages.
#include "runtime/assert.h"
#include "runtime/ecs/debug_hooks.h"
#include "runtime/ecs/destroyed_log.h"
#include "runtime/ecs/name.h"
#include "runtime/ecs/reflection.h"
#include "runtime/ecs/running_system.h"
#include "runtime/ecs/world.h"

#include <fmt/format.h>

namespace penumbra::ecs {

DebugHooks& debugHooks()
{
    static DebugHooks hooks{.value = fieldsText};
    return hooks;
}

// Reads past the checks of access: it runs where one of them has failed.
std::string World::nameOf(Entity entity) const
{
    const DebugHooks& hooks = debugHooks();
    const uint32_t id = hooks.name != nullptr ? hooks.nameComponent : findComponent(Name::kName);
    if (id == kNone || !alive(entity))
        return {};
    const Place at = place(entity);
    const int32_t column = at.archetype->columnOf(static_cast<ComponentId>(id));
    if (column < 0 || (hooks.name == nullptr && componentInfo(id).bytes != sizeof(Name)))
        return {};
    const void* const value = at.archetype->at(column, at.row);
    return hooks.name != nullptr ? hooks.name(value)
                                 : std::string(static_cast<const Name*>(value)->text());
}

std::string World::describe(Entity entity) const
{
    std::string name = nameOf(entity);
    if (m_destroyed != nullptr && !alive(entity))
        if (const DestroyedLog::Entry* entry = m_destroyed->find(entity))
            name = entry->name;
    return name.empty() ? toString(entity) : fmt::format("{} '{}'", toString(entity), name);
}

std::string World::ofEntity(Entity entity) const
{
    return entity.isNull() ? std::string() : " of " + describe(entity);
}

std::string World::currentSystem()
{
    return RunningSystem::name().empty() ? "a system"
                                         : fmt::format("system '{}'", RunningSystem::name());
}

void World::failStale(Entity entity) const
{
    std::string why;
    if (entity.isNull())
        why = "it is the null entity";
    else if (entity.isDeferred())
        why = "it is a command buffer's, real after playback";
    else if (entity.index >= m_entities.indexCount())
        why = fmt::format("the world has {} indices", m_entities.indexCount());
    else
        why = fmt::format("index {} is at generation {}", entity.index,
                          m_entities.generation(entity.index));
    if (m_destroyed == nullptr)
        why += "; after World::rememberDestroyed(true) this message tells what it was";
    else if (const DestroyedLog::Entry* entry = m_destroyed->find(entity))
        why += "; it was destroyed and had: " + toString(entry->components);
    PENUMBRA_ASSERT(false, "entity {} is not alive; {}", describe(entity), why);
    std::abort(); // not reached; the assert does not say so to the compiler
}

void World::failMissing(Entity entity, ComponentId id) const
{
    PENUMBRA_ASSERT(false, "entity {} has no {}; it has: {}", describe(entity),
                    componentInfo(id).name, toString(components(entity)));
    std::abort(); // as above
}

void World::failStructural(Entity entity) const
{
    PENUMBRA_ASSERT(!m_inSystems, "structural change{} in {}: use context.commands()",
                    ofEntity(entity), currentSystem());
    PENUMBRA_ASSERT(m_iterating == 0,
                    "structural change{} during {} iteration(s): use a CommandBuffer",
                    ofEntity(entity), m_iterating);
    PENUMBRA_ASSERT(false, "structural change{} in an observer: use its commands",
                    ofEntity(entity));
    std::abort(); // as above
}

void World::failAdvance() const
{
    PENUMBRA_ASSERT(false, "advance() during {} iteration(s): call it between them", m_iterating);
    std::abort(); // as above
}

void World::failInSystem()
{
    PENUMBRA_ASSERT(false, "World used inside a system ({}): go through SystemContext",
                    currentSystem());
    std::abort(); // as above
}

void World::failNoSingleton(ComponentId id)
{
    PENUMBRA_ASSERT(false, "no singleton {} in this world", componentInfo(id).name);
    std::abort(); // as above
}

void failBulkCount(std::string_view component, size_t values, size_t entities)
{
    PENUMBRA_ASSERT(false, "{} values of {} for {} entities", values, component, entities);
    std::abort(); // as above
}

} // namespace penumbra::ecs
