// Environment maps behind a scene: images on the GPU, and the two bindings of set 0 that pass
// background reads.
#pragma once

#include "assets/environment.h"
#include "runtime/vk/device.h"
#include "runtime/vk/image.h"
#include "shaders/shared/instance.h"

#include <span>
#include <vector>

namespace penumbra {

inline constexpr std::uint32_t kFirstSkyBinding = 20; // kSkyMaps of them
inline constexpr std::uint32_t kBeamMapBinding = 22;
inline constexpr std::uint32_t kSkyNodeBinding = 28; // as storage, and as texels
inline constexpr std::uint32_t kPixelRadianceBinding = 30;
inline constexpr std::uint32_t kSkyLobeBinding = 31;

// A map as it is drawn.
struct SkyMap {
    SkyMap() = default;
    // NOLINTNEXTLINE(google-explicit-constructor): one map as it is, the common case
    SkyMap(const Environment& environment) : map(&environment) {}

    const Environment* map = nullptr; // known by its address: outlives the scene that shows it
    float intensity = 1;
    vec4 rotation{0, 0, 0, 1}; // unit quaternion x, y, z, w: world from map
};

class GpuSkies {
public:
    using Views = std::array<VkImageView, kSkyMaps>;

    GpuSkies() = default;
    explicit GpuSkies(const Device& device);

    // At most kSkyMaps; black where there are fewer. A map's image is made, and waited for, when
    // the map first comes; then it is kept. Error: out of memory; all stays as it was.
    Result<void> set(std::span<const SkyMap> skies);

    // Binds the maps to `set`, which no frame in flight uses, unless `bound` says that they are.
    void bind(VkDescriptorSet set, Views& bound) const;
    // Another image beside them, read at its texels; null: any map, for a pass that reads none.
    void bindImage(VkDescriptorSet set, std::uint32_t binding, const Image* image) const;
    void fill(FrameConstants& frame) const; // skyRotation, skyIntensity

private:
    struct Known {
        const Environment* map;
        Image image;
    };
    Result<VkImageView> viewOf(const Environment* map);

    const Device* m_device = nullptr;
    UniqueSampler m_sampler;
    std::vector<Known> m_known;
    std::array<SkyMap, kSkyMaps> m_skies;
    Views m_views{};
};

} // namespace penumbra
