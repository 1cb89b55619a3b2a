// Entities that go round: the lights and floating objects of scene `lights`.
#pragma once

#include "runtime/ecs/system_context.h"
#include "systems/components.h"

namespace penumbra {

// A circle about the vertical axis through `center`.  Written by: spawn.  Read by: moveOrbits.
struct Orbit {
    static constexpr std::string_view kName = "Orbit";
    vec3 center{0};   // world, or the Parent's space, metres
    float radius = 0; // metres
    float speed = 0;  // rad/s, counter-clockwise from above
    float phase = 0;  // rad at time 0
    float bob = 0;    // metres up and down, twice per turn
    float spin = 0;   // rad/s about its own vertical axis
    float aim = 0;    // 1: its +z looks at `center` instead
};
template <>
inline constexpr auto ecs::kFields<Orbit> = ecs::fields(
    PENUMBRA_FIELD(Orbit, center, .unit = "m"), PENUMBRA_FIELD(Orbit, radius, .unit = "m"),
    PENUMBRA_FIELD(Orbit, speed, .unit = "rad/s"), PENUMBRA_FIELD(Orbit, phase, .unit = "rad"),
    PENUMBRA_FIELD(Orbit, bob, .unit = "m"), PENUMBRA_FIELD(Orbit, spin, .unit = "rad/s"),
    PENUMBRA_FIELD(Orbit, aim, .min = 0, .max = 1));

// Where the entity is `time` seconds from the start.
Transform orbitAt(const Orbit& orbit, const Transform& now, double time);

// System: reads Orbit, writes Transform.
void moveOrbits(const ecs::SystemContext& context, double time);

} // namespace penumbra
