// The colours of surfaces as the rasteriser draws them, for the traced picture: rays find the
// radiance of white receivers (shaders/shared/surface.h), and both pictures get the same textures,
// filtered alike, so that FLIP compares light.
#pragma once

#include "demo/reference/reference.h"
#include "demo/renderer.h"

namespace penumbra {

struct SurfacePicture {
    std::vector<bool> painted;  // [instanceCount] has a surface; empty: none has
    std::vector<vec3> color;    // [height * width] factor of the radiance
    std::vector<vec3> emission; // [height * width] what is added to it, W/(m² sr)
};

// Draws the frame twice more, with radiance 0 and 1, and leaves that radiance in the renderer.
Result<SurfacePicture> drawSurfaces(Renderer& renderer, const View& view);

// Of the pixels that show an instance with a surface.
void paintSurfaces(const SurfacePicture& surfaces, ReferencePicture& picture);

} // namespace penumbra
