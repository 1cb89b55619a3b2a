// Changing the gloss of an object while the demo runs.
#pragma once

#include "demo/scene.h"
#include "systems/frame_constants.h"

#include <optional>

namespace penumbra {

struct PaintKeys {
    bool toggle = false; // matte becomes glossy, glossy matte
    float factor = 1;    // of the exponent
};

// The entity with MeshInstance and Material whose bounding box comes first behind the point of clip
// space (+Y up).
std::optional<ecs::Entity> pick(DemoScene& scene, const View& view, vec2 clip);

// Changes the picked entity's Material as the keys say and prints it. Whether anything changed.
bool paint(DemoScene& scene, const View& view, vec2 clip, const PaintKeys& keys);

} // namespace penumbra
