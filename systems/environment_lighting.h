// All EnvironmentLights of a scene together: their light in SH, and what is drawn of them.
//   EnvironmentLighting lighting(assets, ground);
//   lighting.set(lights);                      // when one changed
//   frameConstants(view, lighting.light());
//   scene.setBackground(lighting.background());
//   scene.setSkyLobes(lighting.lobes());
#pragma once

#include "assets/asset_store.h"
#include "systems/frame_constants.h"
#include "systems/gpu_scene.h"
#include "systems/sky_lobes.h"

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

    // The same sum, filtered for sharp reflections. Made when asked for: 2 ms per light, and as
    // long as filterSky for a map that is new or, over ground, was tilted.
    const SkyLobes& lobes();

    // The lights that are drawn: the kSkyMaps strongest, by intensity times mean luminance.
    [[nodiscard]] const std::vector<SkyMap>& background() const { return m_background; }

private:
    // A map as light, in its axes; over ground, cut at the horizon.
    struct Lit {
        AssetHandle asset;
        vec3 up{0}; // of the world, in the map's axes; 0 without ground
        LightSh light{};
        SkyLobes lobes; // empty until asked for
    };
    Lit& lit(const EnvironmentLight& light);

    const AssetStore& m_assets;
    bool m_ground;
    std::vector<Lit> m_lit;                 // those used last are last
    std::vector<EnvironmentLight> m_lights; // those that are not dark
    LightSh m_light{};
    SkyLobes m_lobes; // empty: to be made
    std::vector<SkyMap> m_background;
};

// What is kept of a light over ground, or the whole map without: for the reference.
Environment litEnvironment(const AssetStore& assets, const EnvironmentLight& light, bool ground);

} // namespace penumbra
