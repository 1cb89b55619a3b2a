#include "systems/gpu_surfaces.h"

#include "runtime/vk/transfer.h"

#include <algorithm>
#include <map>

namespace penumbra {

namespace {

constexpr Binding kBindings[] = {
    {0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_SHADER_STAGE_FRAGMENT_BIT},
    {1, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_SHADER_STAGE_FRAGMENT_BIT},
};

constexpr std::uint64_t kMaxPixelBytes = 1u << 30; // of all images of a scene

VkSamplerAddressMode addressMode(std::uint32_t wrap)
{
    return wrap == 33071   ? VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE
           : wrap == 33648 ? VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT
                           : VK_SAMPLER_ADDRESS_MODE_REPEAT;
}

// The numbers are glTF's, see MeshTexture; 0 is ours to choose: trilinear.
SamplerDesc samplerDesc(const SurfaceTexture& texture)
{
    SamplerDesc desc;
    desc.u = addressMode(texture.wrapS);
    desc.v = addressMode(texture.wrapT);
    desc.mag = texture.magFilter == 9728 ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
    const std::uint32_t min = texture.minFilter == 0 ? 9987 : texture.minFilter;
    desc.min = min == 9728 || min == 9984 || min == 9986 ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
    const bool blend = min == 9986 || min == 9987;
    desc.mipmaps = blend ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
    if (min == 9728 || min == 9729) // no mipmaps; not 0, which would make all magnification
        desc.maxLod = 0.25f;
    return desc;
}

} // namespace

std::span<const Binding> surfaceBindings()
{
    return kBindings;
}

Result<GpuSurfaces> GpuSurfaces::create(const Device& device, SurfaceData& data)
{
    GpuSurfaces surfaces;
    if (data.parts.empty())
        return surfaces;
    if (const Result<void> added = surfaces.addImages(device, data); !added)
        return added.error();
    surfaces.addSamplers(device, data);
    surfaces.addSets(device, data);
    return surfaces;
}

Result<void> GpuSurfaces::addImage(const Device& device, const std::string& name, MipChain pixels,
                                   VkExtent2D extent)
{
    Result<Image> image = createImage(device, {.name = name,
                                               .extent = extent,
                                               .format = VK_FORMAT_R8G8B8A8_SRGB,
                                               .usage = VK_IMAGE_USAGE_SAMPLED_BIT,
                                               .mipLevels = pixels.levels});
    if (!image)
        return image.error();
    m_bytes += pixels.rgba.size();
    m_images.push_back(std::move(*image));
    return upload(device, m_images.back(), std::as_bytes(std::span(pixels.rgba)),
                  VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

Result<void> GpuSurfaces::addImages(const Device& device, SurfaceData& data)
{
    const std::uint32_t maxSide =
        std::min(kMaxTextureSide, device.properties.limits.maxImageDimension2D);
    for (const SurfaceImage& source : data.images) {
        Result<DecodedImage> decoded = decodeImage(source.image, maxSide);
        if (!decoded)
            return fail(decoded.error(), source.place);
        if (m_bytes + decoded->rgba.size() > kMaxPixelBytes)
            return Error{fmt::format("{}: the textures of the scene take over {} bytes; scale them "
                                     "down",
                                     source.place, kMaxPixelBytes)};
        const VkExtent2D extent{decoded->width, decoded->height};
        if (Result<void> added =
                addImage(device, source.place, makeMipChain(std::move(*decoded)), extent);
            !added)
            return added;
    }
    data.images.clear();
    return addImage(device, "no texture", {1, {255, 255, 255, 255}}, {1, 1});
}

void GpuSurfaces::addSamplers(const Device& device, const SurfaceData& data)
{
    std::vector<SamplerDesc> descs;
    const auto add = [&](const SamplerDesc& desc) {
        const auto found = std::find(descs.begin(), descs.end(), desc);
        m_samplerOf.push_back(static_cast<std::uint32_t>(found - descs.begin()));
        if (found != descs.end())
            return;
        descs.push_back(desc);
        m_samplers.push_back(createSampler(device, desc));
    };
    for (const SurfaceTexture& texture : data.textures)
        add(samplerDesc(texture));
    add({}); // of the white image
}

void GpuSurfaces::addSets(const Device& device, const SurfaceData& data)
{
    m_layout = createSetLayout(device, surfaceBindings());
    m_sets = DescriptorSets(device);
    std::map<std::pair<std::uint32_t, std::uint32_t>, VkDescriptorSet> sets;
    for (const SurfacePart& part : data.parts) {
        VkDescriptorSet& set = sets[{part.baseColor, part.emission}];
        if (set == VK_NULL_HANDLE) {
            set = m_sets.allocate(m_layout);
            DescriptorWriter writer(device, set);
            for (const auto& [binding, texture] :
                 {std::pair{0u, part.baseColor}, {1u, part.emission}}) {
                const bool none = texture == kNoTexture;
                const Image& image =
                    none ? m_images.back() : m_images[data.textures[texture].image];
                writer.sampledImage(binding, image.view,
                                    m_samplers[none ? m_samplerOf.back() : m_samplerOf[texture]]);
            }
            writer.write();
        }
        m_partSets.push_back(set);
    }
}

} // namespace penumbra
