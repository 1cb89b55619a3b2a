// The draws of pass raster: each instance by its radiance alone (pipeline raster), or with the
// colours of its surface (raster_surface), one draw per part.
#pragma once

#include "systems/frame.h"

namespace penumbra {

// Inside the rendering of pass raster, with the index buffer bound. `set`: of layout
// sceneBindings(). `surfaces`: see FrameOptions.
void drawInstances(const GpuFrame& gpu, const RasterPasses& passes, const GpuScene& scene,
                   VkDescriptorSet set, bool surfaces);

// raster_surface from raster: vertex buffer 3, set 1 and push constants more.
GraphicsDesc surfaceDesc(GraphicsDesc raster);

} // namespace penumbra
