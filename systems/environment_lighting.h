// All EnvironmentLights of a scene together: their light in SH, and what is drawn of them.
//   EnvironmentLighting lighting(assets, ground);
//   lighting.set(lights);                      // when one changed
//   frameConstants(view, lighting.light());
//   scene.setBackground(lighting.background());
#pragma once

#include "assets/asset_store.h"
#include "systems/frame_constants.h"
#include "systems/gpu_scene.h"

namespace penumbra {

class EnvironmentLighting {
public:
    // `assets` outlives it. `ground`: y < 0 is solid and dark, see aboveGround.
    EnvironmentLighting(const AssetStore& assets, bool ground) : m_assets(assets), m_ground(ground)
    {}

    // Every light names an environment of the store (asserted). Takes 0.03 ms per light, and over
    // ground as long as aboveGround for a map that is new or was tilted: by more than 0.006
    // degrees, a hundredth of the largest map's pixel.
    void set(std::span<const EnvironmentLight> lights);

    // The sum over the lights of intensity * rotated radiance, W/(m² sr).
    [[nodiscard]] const LightSh& light() const { return m_light; }

    // The lights that are drawn: the kSkyMaps strongest, by intensity times mean luminance.
    [[nodiscard]] const std::vector<SkyMap>& background() const { return m_background; }

private:
    // The SH of a map cut at the horizon, in the map's axes.
    struct Cut {
        AssetHandle asset;
        vec3 up{0}; // of the world, in the map's axes
        LightSh light{};
    };
    const LightSh& lightOf(AssetHandle asset, vec3 up);

    const AssetStore& m_assets;
    bool m_ground;
    std::vector<Cut> m_cuts; // those used last are last
    LightSh m_light{};
    std::vector<SkyMap> m_background;
};

// What is kept of a light over ground, or the whole map without: for the reference.
Environment litEnvironment(const AssetStore& assets, const EnvironmentLight& light, bool ground);

} // namespace penumbra
