// The templates of query.h, which includes this file: each() and the like.
#pragma once

#include "runtime/ecs/query_changed.h"

namespace penumbra::ecs {

template <class... Terms>
template <bool kWhole, class Visit>
void Query<Terms...>::forRunsOf(const Match& match, uint32_t segment, Visit&& visit) const
{
    const Archetype& archetype = *match.archetype;
    const uint32_t first = segment << archetype.segmentShift();
    const uint32_t rows = std::min(archetype.segmentRows(), archetype.count() - first);
    if (kWhole || kSeesDisabled || archetype.disabled().count(segment) == 0) [[likely]]
        return visit(Run{&match, segment, 0, rows});
    archetype.disabled().eachEnabledRun(first, first + rows, [&](uint32_t row, uint32_t count) {
        visit(Run{&match, segment, row - first, count});
    });
}

template <class... Terms>
template <bool kWhole, class Visit>
void Query<Terms...>::forRuns(Visit&& visit) const
{
    const IterationGuard guard(*m_iterating);
    for (const Match& match : m_cache->matches())
        for (uint32_t s = archetypePasses(match) ? 0 : kNone; s < match.archetype->segmentCount();
             ++s)
            if (segmentPasses(match, s))
                forRunsOf<kWhole>(match, s, visit);
}

template <class... Terms>
template <class Call>
void Query<Terms...>::forTasks(size_t count, Call&& call)
{
    const auto tasks = static_cast<uint32_t>(count);
    if (tasks >= kInlineSegments)
        return parallelFor(tasks, call);
    for (uint32_t i = 0; i < tasks; ++i)
        call(i);
}

template <class... Terms>
template <class F>
void Query<Terms...>::eachSegment(F&& f) const
{
    uint32_t ordinal = 0;
    forRuns<false>([&](const Run& run) { callSegment(f, run, ordinal++); });
}

template <class... Terms>
template <class F>
void Query<Terms...>::parallelEachSegment(F&& f) const
{
    // A task per segment, whatever its runs: they share change marks, which one thread writes.
    struct Task {
        Run segment;
        uint32_t ordinal; // of its first run
    };
    std::vector<Task> tasks;
    uint32_t ordinal = 0;
    forRuns<true>([&](const Run& segment) {
        tasks.push_back({segment, ordinal});
        forRunsOf<false>(*segment.match, segment.segment, [&](const Run&) { ++ordinal; });
    });
    const IterationGuard guard(*m_iterating);
    forTasks(tasks.size(), [&](uint32_t i) {
        uint32_t at = tasks[i].ordinal;
        forRunsOf<false>(*tasks[i].segment.match, tasks[i].segment.segment,
                         [&](const Run& run) { callSegment(f, run, at++); });
    });
}

template <class... Terms>
template <class F>
void Query<Terms...>::each(F&& f) const
{
    if constexpr (kChangedCount > 0) {
        const IterationGuard guard(*m_iterating);
        for (const Match& match : m_cache->matches()) {
            if (!archetypePasses(match))
                continue;
            const uint32_t segments = match.archetype->segmentCount();
            const Changes changes = this->changes(match);
            const uint32_t blockSegments =
                std::max(match.archetype->blockRows() >> match.archetype->segmentShift(), 1u);
            const uint32_t step = std::min(blockSegments, kListedSegments);
            for (uint32_t s = 0; s < segments; s += step)
                callChanged(f, match, changes, s, std::min(s + step, segments) - 1);
        }
        return;
    }
    // Few instructions up to the rows: where archetypes are small, and each loop's end hard to
    // guess, they are what a walk costs.
    const IterationGuard guard(*m_iterating);
    const std::span<const Word> walks = m_cache->walks();
    const Word* const end = walks.data() + walks.size();
    for (const Word* walk = walks.data(); walk != end; walk += kWalkWords) {
        Archetype& archetype = *QueryCache::load<Archetype*>(walk + QueryCache::kArchetype);
        const Word shape = QueryCache::load(walk + QueryCache::kShape);
        if (shape == archetype.shape()) [[likely]] {
            callFirst(f, archetype, static_cast<uint32_t>(shape), walk, DataIndices(),
                      FlatIndices());
        } else {
            // By a copy: then this Query need not be in memory.
            Query copy(*m_cache, m_stamp, m_since, *m_iterating);
            const auto i = static_cast<size_t>(walk - walks.data()) / kWalkWords;
            copy.callAll(f, m_cache->matches()[i]);
        }
    }
}

template <class... Terms>
template <class F>
void Query<Terms...>::parallelEach(F&& f) const
{
    const IterationGuard guard(*m_iterating);
    if constexpr (kChangedCount > 0) {
        struct Task {
            const Match* match;
            uint32_t segment;
            Changes changes;
        };
        std::vector<Task> tasks;
        for (const Match& match : m_cache->matches()) {
            if (!archetypePasses(match))
                continue;
            const Changes changes = this->changes(match);
            for (uint32_t s = 0; s < match.archetype->segmentCount(); ++s)
                if (segmentPasses(match, s))
                    tasks.push_back({&match, s, changes});
        }
        forTasks(tasks.size(), [&](uint32_t i) {
            callChanged(f, *tasks[i].match, tasks[i].changes, tasks[i].segment, tasks[i].segment);
        });
    } else {
        // Several segments of a block in one task, where there are plenty: longer loops cost less.
        struct Task {
            const Match* match;
            uint32_t segment; // the first
            uint32_t count;
        };
        const uint32_t most = std::min(segmentCount() / 64 + 1, kTaskSegments);
        std::vector<Task> tasks;
        for (const Match& match : m_cache->matches())
            for (uint32_t s = 0; s < match.archetype->segmentCount(); s += tasks.back().count)
                tasks.push_back({&match, s,
                                 std::min(std::min(most, kBlockSegments - s % kBlockSegments),
                                          match.archetype->segmentCount() - s)});
        forTasks(tasks.size(), [&](uint32_t i) {
            const Task& task = tasks[i];
            const Archetype& archetype = *task.match->archetype;
            if (skips(archetype)) [[unlikely]] {
                for (uint32_t s = 0; s < task.count; ++s)
                    forRunsOf<false>(*task.match, task.segment + s,
                                     [&](const Run& enabled) { callMarked(f, enabled); });
                return;
            }
            const uint32_t rows = archetype.segmentRows();
            const uint32_t first = task.segment * rows;
            const uint32_t count = std::min(task.count * rows, archetype.count() - first);
            mark(*task.match, first, count);
            callRun(f, *task.match, first, count, FlatIndices());
        });
    }
}

} // namespace penumbra::ecs
