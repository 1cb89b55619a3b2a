// What the keys of the window do to the sky. A key takes the sky from the scene's script
// (SkyMotion).
#pragma once

#include "demo/scene.h"

namespace penumbra {

// About the vertical, counter-clockwise from above.
void turnSky(ecs::World& world, float radians);

void scaleSky(ecs::World& world, float factor);

// Fades within `seconds` (> 0) from the skies that shine to the next environment of the folder, by
// name; their intensities always add up to the same. Error: it is missing or damaged.
Result<void> fadeToNextSky(DemoScene& scene, const std::filesystem::path& assets, float seconds);

} // namespace penumbra
