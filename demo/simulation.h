// The CPU side of a frame: the ECS schedule that moves a scene, and what the renderer is told of
// it.
#pragma once

#include "demo/scene.h"
#include "runtime/ecs/schedule.h"
#include "systems/extract.h"
#include "systems/gpu_scene.h"

namespace penumbra {

class Simulation {
public:
    explicit Simulation(DemoScene& scene);

    // Advances the scene and returns the instances that moved.
    std::span<const ChangedInstance> advance(float seconds);

    [[nodiscard]] std::vector<ecs::Schedule::Timing> timings() const
    {
        return m_schedule.timings();
    }

private:
    float m_seconds = 0;
    std::vector<ChangedInstance> m_changed;
    ecs::Schedule m_schedule;
};

// The instance's new place, its other properties unchanged.
SceneInstance moved(const SceneData& scene, const ChangedInstance& changed);

} // namespace penumbra
