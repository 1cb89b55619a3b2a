// Tamura et al. 2006, third scene: 20 dynamic objects under an environment map, at least 88,739
// vertices in all.
#pragma once

#include "demo/scene.h"

namespace penumbra {

Result<std::unique_ptr<DemoScene>> loadFallingScene(const SceneOptions& options);

// The same on a floor of two triangles, which only pixel receivers show right.
Result<std::unique_ptr<DemoScene>> loadCoarseScene(const SceneOptions& options);

} // namespace penumbra
