// Scene "materials": rows of glossy balls, a textured ball and a knot with vertex colours.
#pragma once

#include "demo/scene.h"

namespace penumbra {

Result<std::unique_ptr<DemoScene>> loadMaterialsScene(const SceneOptions& options);

} // namespace penumbra
