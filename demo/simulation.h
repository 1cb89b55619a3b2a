// The CPU side of a frame: the ECS schedule that moves a scene, and what the renderer is told of
// it.
#pragma once

#include "demo/scene.h"
#include "runtime/ecs/schedule.h"
#include "systems/extract.h"

namespace penumbra {

class Simulation {
public:
    explicit Simulation(DemoScene& scene);

    // Advances the scene and returns what changed.
    const SceneChanges& advance(float seconds);

    [[nodiscard]] std::vector<ecs::Schedule::Timing> timings() const
    {
        return m_schedule.timings();
    }

private:
    float m_seconds = 0; // of the step
    double m_time = 0;   // since the start
    SceneChanges m_changes;
    ecs::Schedule m_schedule;
};

} // namespace penumbra
