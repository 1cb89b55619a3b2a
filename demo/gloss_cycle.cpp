#include "demo/gloss_cycle.h"

#include <cmath>
#include <numbers>

namespace penumbra {

float exponentAt(const GlossCycle& cycle, double time)
{
    const double turn = std::fmod(time / cycle.period + cycle.phase, 1.0);
    const double part = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * turn);
    return cycle.low * std::pow(cycle.high / cycle.low, static_cast<float>(part));
}

void cycleGloss(const ecs::SystemContext& context, double time)
{
    context.query<const GlossCycle, Material>().each(
        [&](const GlossCycle& cycle, Material& material) {
            material.glossExponent = exponentAt(cycle, time);
        });
}

} // namespace penumbra
