// A window with an orbit camera. Headless runs never call it.
#pragma once

#include "demo/options.h"
#include "runtime/result.h"

namespace penumbra {

// Until the window closes or options.frames are drawn. Error: no display, no device, a scene that
// does not load.
Result<void> runWindow(const DemoOptions& options);

} // namespace penumbra
