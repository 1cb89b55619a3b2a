// Query::eachDown(), included by world.h.
#pragma once

#include "runtime/ecs/hierarchy.h"
#include "runtime/ecs/query.h"

namespace penumbra::ecs {

// Goes by runs of slots, as Hierarchy found them: within one, rows are arrays. Parents come in the
// order of their slots, so that the parent's run is found by going on from the last one's.
template <class... Terms>
template <class F>
void Query<Terms...>::eachDown(const Hierarchy& hierarchy, F&& f) const
{
    static_assert(kDataCount > 0 && kChangedCount == 0);
    static_assert(!Argument<0>::kSplit, "split into lanes, the parent's value has no address");
    using First = const typename Argument<0>::T;
    const IterationGuard guard(*m_iterating);
    const uint32_t* const parentSlots = hierarchy.parentSlots().data();
    const std::span<const Hierarchy::Run> runs = hierarchy.runs();

    const auto matchOf = [&](const Archetype* archetype) -> const Match* {
        for (const Match& match : m_cache->matches())
            if (match.archetype == archetype)
                return &match;
        return nullptr;
    };
    const Hierarchy::Run* above = nullptr; // the run of the current parent
    const Match* aboveMatch = nullptr;
    const auto valueAt = [&](uint32_t slot) -> First* {
        if (above == nullptr || slot >= above->slot + above->count) {
            above = above == nullptr ? runs.data() : above + 1;
            while (slot >= above->slot + above->count)
                ++above;
            aboveMatch = matchOf(above->archetype);
        }
        if (aboveMatch == nullptr || aboveMatch->columns[0] < 0)
            return nullptr;
        const auto column = static_cast<uint32_t>(aboveMatch->columns[0]);
        return reinterpret_cast<First*>(
            above->archetype->at(column, above->row + slot - above->slot));
    };

    for (const Hierarchy::Run& run : runs) {
        const Match* const match = matchOf(run.archetype);
        if (match == nullptr)
            continue;
        const Archetype& archetype = *run.archetype;
        const bool skipsSome = skips(archetype); // then rows are marked one by one
        if (!skipsSome)
            mark(*match, run.row, run.count);
        const auto columns = columnPointers(*match, run.row, FlatIndices());
        [[maybe_unused]] const Entity* const entities = archetype.entities().data() + run.row;
        uint32_t parentSlot = kNone;
        First* parent = nullptr;
        for (uint32_t i = 0; i < run.count; ++i) {
            if (skipsSome) [[unlikely]] {
                if (archetype.disabled().test(run.row + i))
                    continue;
                mark(*match, run.row + i, 1);
            }
            if (const uint32_t slot = parentSlots[run.slot + i]; slot != parentSlot) {
                parentSlot = slot;
                parent = slot == kNone ? nullptr : valueAt(slot);
            }
            [&]<size_t... k>(std::index_sequence<k...>)
            {
                Arguments arguments;
                (std::get<k>(arguments).template load<Flat::first(k)>(columns, i), ...);
                if constexpr (std::is_invocable_v<
                                  F&, Entity, decltype(std::get<k>(arguments).get())..., First*>)
                    f(entities[i], std::get<k>(arguments).get()..., parent);
                else
                    f(std::get<k>(arguments).get()..., parent);
                (std::get<k>(arguments).template store<Flat::first(k)>(columns, i), ...);
            }
            (DataIndices());
        }
    }
}

} // namespace penumbra::ecs
