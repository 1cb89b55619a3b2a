// Two coloured spheres and a picture that shines move among objects, under a dim sky.
#pragma once

#include "demo/scene.h"

namespace penumbra {

Result<std::unique_ptr<DemoScene>> loadLightsScene(const SceneOptions& options);

} // namespace penumbra
