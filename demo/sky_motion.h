// Skies that turn and fade: scripted, as in scene `sky`, or for a while after a key.
#pragma once

#include "runtime/ecs/system_context.h"
#include "systems/components.h"

namespace penumbra {

// The entity's EnvironmentLight turns about the vertical, and comes and goes. Two with phases 0 and
// 1/2 always add up to the same intensity.  Written by: spawn.  Read by: moveSkies.
struct SkyMotion {
    static constexpr std::string_view kName = "SkyMotion";
    float intensity = 1; // when it is there
    float turn = 0;      // rad/s, counter-clockwise from above
    float period = 0;    // seconds from there to there; 0: it stays
    float phase = 0;     // at time 0, in periods; 1/2: it is gone
};
template <>
inline constexpr auto ecs::kFields<SkyMotion> =
    ecs::fields(PENUMBRA_FIELD(SkyMotion, intensity, .min = 0, .max = 1e6),
                PENUMBRA_FIELD(SkyMotion, turn, .unit = "rad/s"),
                PENUMBRA_FIELD(SkyMotion, period, .unit = "s", .min = 0, .max = 1e4),
                PENUMBRA_FIELD(SkyMotion, phase));

// The light `time` seconds from the start.
EnvironmentLight skyAt(const SkyMotion& motion, const EnvironmentLight& now, double time);

// System: reads SkyMotion, writes EnvironmentLight.
void moveSkies(const ecs::SystemContext& context, double time);

// The intensity moves to `to` and stays there; at 0 the entity goes.  Written by: input.  Read by:
// fadeSkies.
struct SkyFade {
    static constexpr std::string_view kName = "SkyFade";
    float to = 0;        // >= 0
    float perSecond = 1; // > 0
};
template <>
inline constexpr auto ecs::kFields<SkyFade> =
    ecs::fields(PENUMBRA_FIELD(SkyFade, to, .min = 0, .max = 1e6),
                PENUMBRA_FIELD(SkyFade, perSecond, .min = 1e-6, .max = 1e6));

// System: reads SkyFade, writes EnvironmentLight; ends fades.
void fadeSkies(const ecs::SystemContext& context, float seconds);

} // namespace penumbra
