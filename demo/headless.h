// A run without a window: frames at 60 per second of scene time to PNG, film, benchmark and
// reference.
#pragma once

#include "demo/options.h"
#include "demo/scene.h"
#include "runtime/vk/device.h"

namespace penumbra {

Result<void> runHeadless(const Device& device, DemoScene& scene, const DemoOptions& options);

} // namespace penumbra
