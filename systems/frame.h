// One frame on the GPU. frame.cpp lists its passes and barriers in order; it records into the
// command buffer of whoever owns the frame (our ring or a host's) and leaves the picture in
// `display`.
#pragma once

#include "runtime/vk/frame_ring.h"
#include "runtime/vk/pipeline.h"
#include "systems/frame_constants.h"
#include "systems/gpu_scene.h"
#include "systems/pixel_receivers.h"
#include "systems/techniques/shadow_fields/kernel.h"

namespace penumbra {

// Pass raster: instances of one colour, and those with textures or several materials.
struct RasterPasses {
    Pipeline plain, surface;
};

// Pipelines of all passes. Compiled once per device: about 2 CPU-seconds on lavapipe.
struct FramePasses {
    Pipeline instanceUpdate, clusterCull, entitySort, combineLiteral, background, post;
    Pipeline beamMap, beams;               // shaders/shared/beam.h
    Pipeline combineExact, combineMirrors; // the second with what mirrors the filtered sky
    RasterPasses raster, rasterPixels;     // radiance of vertices, of pixels
    // `mirrors`: GpuScene::mirrors().
    [[nodiscard]] const Pipeline& combine(Kernel kernel, bool mirrors) const
    {
        return kernel == Kernel::Literal ? combineLiteral : mirrors ? combineMirrors : combineExact;
    }
};
// What a scene asks of its passes: without, they are smaller and faster.
struct SceneFeatures {
    bool lights = false; // of its own
    bool hiders = false; // SceneData::hiders
};
SceneFeatures sceneFeatures(const SceneData& scene);
Result<FramePasses> createFramePasses(const Device& device, SceneFeatures features);

// Targets of one size.
struct FrameTargets {
    Image radiance; // RGBA16F, linear; after a frame in VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL
    Image depth;
    // RGBA8, sRGB-encoded; after a frame in VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL. May be drawn on.
    Image display;
    UniqueSampler sampler;
    VkDescriptorSet postSet = VK_NULL_HANDLE;
    DescriptorSets sets;
};
Result<FrameTargets> createFrameTargets(const Device& device, const FramePasses& passes,
                                        VkExtent2D extent);

struct FrameOptions {
    Kernel kernel = Kernel::Exact;
    bool combine = true; // false: the radiance buffer is given from outside (reference, cpu-scalar)
    float exposure = 1;
    bool surfaces = true; // false: the picture is the radiance of the receivers, nothing else
    const PixelReceivers* pixels = nullptr; // of the targets' size; null: vertices receive light
};

// Records everything from changed instances to `targets.display`.
void recordFrame(const GpuFrame& gpu, const FramePasses& passes, GpuScene& scene,
                 const FrameConstants& constants, const FrameOptions& options,
                 const FrameTargets& targets);

// Clusters of receivers that entity_sort and combine work on.
struct ReceiverClusters {
    VkDescriptorSet set = VK_NULL_HANDLE; // of layout sceneBindings()
    VkBuffer cull = VK_NULL_HANDLE;       // CullResult
};
ReceiverClusters receiverClusters(const GpuFrame& gpu, const GpuScene& scene,
                                  const PixelReceivers* pixels);

// The parts. Each takes and leaves the targets as the next one wants them.
void recordInstanceUpdate(const GpuFrame& gpu, const FramePasses& passes, const GpuScene& scene);
void recordClusterCull(const GpuFrame& gpu, const FramePasses& passes, const GpuScene& scene);
void recordEntitySort(const GpuFrame& gpu, const FramePasses& passes,
                      const ReceiverClusters& receivers);
void recordCombine(const GpuFrame& gpu, const FramePasses& passes,
                   const ReceiverClusters& receivers, Kernel kernel, bool mirrors);
// With beams only.
void recordBeamMaps(const GpuFrame& gpu, const FramePasses& passes, const GpuScene& scene);
void recordBeams(const GpuFrame& gpu, const FramePasses& passes, const ReceiverClusters& receivers);
void recordRaster(const GpuFrame& gpu, const FramePasses& passes, const GpuScene& scene,
                  const FrameTargets& targets, bool surfaces = true,
                  const PixelReceivers* pixels = nullptr);
void recordPost(const GpuFrame& gpu, const FramePasses& passes, const FrameTargets& targets,
                float exposure);

} // namespace penumbra
