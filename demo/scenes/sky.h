// The sky over objects at rest turns once, and fades to another and back, in 8 s.
#pragma once

#include "demo/scene.h"

namespace penumbra {

Result<std::unique_ptr<DemoScene>> loadSkyScene(const SceneOptions& options);

} // namespace penumbra
