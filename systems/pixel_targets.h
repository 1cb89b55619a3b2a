// What the passes of pixels that receive light pass on to each other, and to entity_sort and
// combine.
#pragma once

#include "systems/gpu_scene.h"

namespace penumbra {

struct PixelPasses;

// Targets of one size and one scene: about 130 bytes per pixel at rate 1, 90 at rate 2.
struct PixelTargets {
    VkExtent2D extent = {};
    std::uint32_t capacity = 0;               // clusters
    Image geometry, selfVisibility, instance; // after pass gbuffer in layout SHADER_READ_ONLY
    Image radiance; // RGBA16F; after pass pixel_resolve in layout SHADER_READ_ONLY
    Buffer receivers, bounds, clusters, cull, visible, lists; // as GpuSceneBuffers has them
    Buffer receiverRadiance;                                  // [receiver] vec4
    Buffer counts; // [cluster] receivers; the other lanes of a cluster mean nothing
    Buffer slots;  // [height][width] index of the pixel's receiver, kNoSlot: none
    UniqueSampler sampler;
    DescriptorSets sets;
    VkDescriptorSet set = VK_NULL_HANDLE;   // of shaders/pixel.glsl
    std::vector<VkDescriptorSet> sceneSets; // [slot] of shaders/scene.glsl, with these receivers
};
// The scene outlives the targets. Error: out of memory, or a size that the device
// cannot bind or dispatch.
Result<PixelTargets> createPixelTargets(const Device& device, const PixelPasses& passes,
                                        const GpuScene& scene, VkExtent2D extent);

std::uint64_t gpuBytes(const PixelTargets& targets);

// What pass gbuffer wrote: [height][width].
struct GbufferPixels {
    std::vector<ReceiverTexels> receivers; // object space
    std::vector<std::uint32_t> instances;  // kBackground: none, its receiver means nothing
};
Result<GbufferPixels> readGbuffer(const Device& device, const PixelTargets& targets);

} // namespace penumbra
