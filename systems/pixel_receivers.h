// Pixels that receive light in place of vertices: what a coarse mesh, a floor of two triangles,
// needs to show a shadow. Four passes around entity_sort and combine, which work on the clusters of
// pixels as on those of vertices (docs/decisions/0010-pixel-receivers.md); systems/frame.cpp has
// their order.
//   gbuffer         what each pixel shows, as a receiver in object space
//   pixel_clusters  receivers of one instance that lie together -> clusters of 64
//   pixel_bounds    their spheres and cones of normals
//   pixel_resolve   radiance of receivers -> of pixels; at rate 2, the pixels between
#pragma once

#include "runtime/vk/frame_ring.h"
#include "runtime/vk/pipeline.h"
#include "systems/pixel_targets.h"

namespace penumbra {

// Compiled once per device and rate: 1, every pixel is a receiver; 2, every second one both ways,
// and those that no neighbours can stand for.
struct PixelPasses {
    std::uint32_t rate = 1;
    Pipeline gbuffer, clusters, bounds, resolve;
};
Result<PixelPasses> createPixelPasses(const Device& device, std::uint32_t rate);

struct PixelReceivers {
    PixelPasses passes;
    PixelTargets targets;
};

// Draws into `depth` too, of the targets' size, and leaves it as a depth target.
void recordGbuffer(const GpuFrame& gpu, const PixelReceivers& pixels, const GpuScene& scene,
                   const Image& depth);
void recordPixelClusters(const GpuFrame& gpu, const PixelReceivers& pixels);
void recordPixelBounds(const GpuFrame& gpu, const PixelReceivers& pixels);
void recordPixelResolve(const GpuFrame& gpu, const PixelReceivers& pixels);

} // namespace penumbra
