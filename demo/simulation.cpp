#include "demo/simulation.h"

#include "demo/gloss_cycle.h"
#include "demo/orbit.h"
#include "demo/sky_motion.h"
#include "systems/physics_system.h"
#include "systems/transforms.h"

namespace penumbra {

Simulation::Simulation(DemoScene& scene) : m_schedule(scene.world, {"simulate", "place", "extract"})
{
    if (scene.physics) {
        m_schedule.add<const PhysicsBody, Transform>(
            "physics", "simulate", [this, &scene](ecs::SystemContext& context) {
                stepPhysics(context, *scene.physics, m_seconds);
            });
    }
    m_schedule.add<const Orbit, Transform>(
        "orbits", "simulate", [this](ecs::SystemContext& context) { moveOrbits(context, m_time); });
    m_schedule.add<const GlossCycle, Material>(
        "gloss", "simulate", [this](ecs::SystemContext& context) { cycleGloss(context, m_time); });
    m_schedule.add<const SkyMotion, EnvironmentLight>(
        "skies", "simulate", [this](ecs::SystemContext& context) { moveSkies(context, m_time); });
    m_schedule.add<const SkyFade, EnvironmentLight>(
        "sky fades", "simulate",
        [this](ecs::SystemContext& context) { fadeSkies(context, m_seconds); });
    m_schedule.add<const Transform, WorldTransform>("transforms", "place", updateWorldTransforms);
    m_schedule.add<const Transform, const WorldTransform, const Material, const ShadowFieldEmitter,
                   const EnvironmentLight, const RenderInstance, const RenderLight>(
        "gather", "extract",
        [this](ecs::SystemContext& context) { gatherChanged(context, m_changes); });
}

const SceneChanges& Simulation::advance(float seconds)
{
    m_seconds = seconds;
    m_time += seconds;
    m_changes.clear();
    m_schedule.run();
    return m_changes;
}

} // namespace penumbra
