// The textures of a scene on the GPU, and the descriptor set of each draw that uses some (set 1 of
// pass raster_surface).
#pragma once

#include "assets/image_decoder.h"
#include "runtime/vk/descriptors.h"
#include "runtime/vk/device.h"
#include "runtime/vk/image.h"
#include "systems/surface_data.h"

namespace penumbra {

// Set 1: base colour and emissive texture.
std::span<const Binding> surfaceBindings();

class GpuSurfaces {
public:
    // Decodes and uploads the images, one at a time, and lets go of their files: `data.images` is
    // empty afterwards. Error: an image that cannot be decoded, or no memory; the message names it.
    static Result<GpuSurfaces> create(const Device& device, SurfaceData& data);

    // Of a part of SurfaceData.
    [[nodiscard]] VkDescriptorSet set(std::uint32_t part) const { return m_partSets[part]; }
    [[nodiscard]] std::uint64_t bytes() const { return m_bytes; } // of the images

private:
    Result<void> addImage(const Device& device, const std::string& name, MipChain pixels,
                          VkExtent2D extent);
    Result<void> addImages(const Device& device, SurfaceData& data);
    void addSamplers(const Device& device, const SurfaceData& data);
    void addSets(const Device& device, const SurfaceData& data);

    std::vector<Image> m_images; // by image, then the white one
    std::vector<UniqueSampler> m_samplers;
    std::vector<std::uint32_t> m_samplerOf; // by texture
    UniqueDescriptorSetLayout m_layout;
    DescriptorSets m_sets;
    std::vector<VkDescriptorSet> m_partSets;
    std::uint64_t m_bytes = 0;
};

} // namespace penumbra
