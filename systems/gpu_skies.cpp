#include "systems/gpu_skies.h"

#include "runtime/vk/descriptors.h"
#include "runtime/vk/transfer.h"

#include <glm/gtc/packing.hpp>

namespace penumbra {

namespace {

Result<Image> uploadMap(const Device& device, const Environment& environment)
{
    Result<Image> image =
        createImage(device, {.name = "environment map",
                             .extent = {environment.mapWidth, environment.mapHeight},
                             .format = VK_FORMAT_R16G16B16A16_SFLOAT,
                             .usage = VK_IMAGE_USAGE_SAMPLED_BIT});
    if (!image)
        return image;
    std::vector<std::uint64_t> pixels;
    for (const vec3& radiance : environment.map)
        pixels.push_back(glm::packHalf4x16(vec4(radiance, 1)));
    if (Result<void> done = penumbra::upload(device, *image, std::as_bytes(std::span(pixels)),
                                             VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
        !done)
        return done.error();
    return image;
}

} // namespace

GpuSkies::GpuSkies(const Device& device)
    : m_device(&device),
      m_sampler(createSampler(device, VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT))
{}

Result<VkImageView> GpuSkies::viewOf(const Environment* map)
{
    static const Environment kBlack{.mapWidth = 1, .mapHeight = 1, .map = {vec3(0)}};
    if (map == nullptr)
        map = &kBlack;
    for (const Known& known : m_known)
        if (known.map == map)
            return VkImageView{known.image.view};
    Result<Image> image = uploadMap(*m_device, *map);
    if (!image)
        return image.error();
    m_known.push_back({map, std::move(*image)});
    return VkImageView{m_known.back().image.view};
}

Result<void> GpuSkies::set(std::span<const SkyMap> skies)
{
    PENUMBRA_ASSERT(skies.size() <= kSkyMaps, "{} maps behind the scene, at most {}", skies.size(),
                    kSkyMaps);
    std::array<SkyMap, kSkyMaps> wanted;
    Views views{};
    for (std::size_t i = 0; i < kSkyMaps; ++i) {
        wanted[i].intensity = 0;
        if (i < skies.size())
            wanted[i] = skies[i];
        const Result<VkImageView> view = viewOf(wanted[i].map);
        if (!view)
            return view.error();
        views[i] = *view;
    }
    m_skies = wanted;
    m_views = views;
    return {};
}

void GpuSkies::bind(VkDescriptorSet set, Views& bound) const
{
    if (bound == m_views)
        return;
    DescriptorWriter writer(*m_device, set);
    for (std::uint32_t i = 0; i < kSkyMaps; ++i)
        writer.sampledImage(kFirstSkyBinding + i, m_views[i], m_sampler);
    writer.write();
    bound = m_views;
}

void GpuSkies::bindImage(VkDescriptorSet set, std::uint32_t binding, const Image* image) const
{
    const VkImageView view = image != nullptr ? VkImageView{image->view} : m_views[0];
    DescriptorWriter(*m_device, set).sampledImage(binding, view, m_sampler).write();
}

void GpuSkies::fill(FrameConstants& frame) const
{
    for (std::size_t i = 0; i < kSkyMaps; ++i) {
        const vec4 q = m_skies[i].rotation;
        frame.skyRotation[i] = vec4(-vec3(q), q.w);
        frame.skyIntensity[i] = m_skies[i].intensity;
    }
}

} // namespace penumbra
