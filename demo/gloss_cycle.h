// Entities whose gloss changes all the time: the balls of scene `materials`.
#pragma once

#include "runtime/ecs/system_context.h"
#include "systems/components.h"

namespace penumbra {

// The exponent of the entity's Material goes up and down, evenly in its logarithm.  Written by:
// spawn.  Read by: cycleGloss.
struct GlossCycle {
    static constexpr std::string_view kName = "GlossCycle";
    float low = 2, high = 64; // exponents, > 0
    float period = 6;         // seconds
    float phase = 0;          // parts of a period at time 0; 0: at `low`
};
template <>
inline constexpr auto ecs::kFields<GlossCycle> =
    ecs::fields(PENUMBRA_FIELD(GlossCycle, low, .min = 0.01, .max = 1e4),
                PENUMBRA_FIELD(GlossCycle, high, .min = 0.01, .max = 1e4),
                PENUMBRA_FIELD(GlossCycle, period, .unit = "s", .min = 0.01, .max = 1e4),
                PENUMBRA_FIELD(GlossCycle, phase));

float exponentAt(const GlossCycle& cycle, double time);

// System: reads GlossCycle, writes Material.
void cycleGloss(const ecs::SystemContext& context, double time);

} // namespace penumbra
