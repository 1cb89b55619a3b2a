#include "demo/simulation.h"

#include "systems/physics_system.h"

namespace penumbra {

Simulation::Simulation(DemoScene& scene) : m_schedule(scene.world, {"simulate", "extract"})
{
    if (scene.physics) {
        m_schedule.add<const RigidBody, Transform>(
            "physics", "simulate", [this, &scene](ecs::SystemContext& context) {
                stepPhysics(context, *scene.physics, m_seconds);
            });
    }
    m_schedule.add<const Transform, const RenderInstance>(
        "gather", "extract",
        [this](ecs::SystemContext& context) { gatherChanged(context, m_changed); });
}

std::span<const ChangedInstance> Simulation::advance(float seconds)
{
    m_seconds = seconds;
    m_changed.clear();
    m_schedule.run();
    return m_changed;
}

SceneInstance moved(const SceneData& scene, const ChangedInstance& changed)
{
    SceneInstance instance = scene.instances[changed.index];
    instance.position = changed.transform.position;
    instance.scale = changed.transform.scale;
    instance.rotation = changed.transform.rotation;
    return instance;
}

} // namespace penumbra
