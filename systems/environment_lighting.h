// All EnvironmentLights of a scene together: their light in SH, and what is drawn of them.
//   EnvironmentLighting lighting(assets, ground);
//   lighting.set(lights);                      // when one changed
//   frameConstants(view, lighting.light());
//   scene.setBackground(lighting.background());
//   scene.setBeams(lighting.beams());
//   scene.setSkyLobes(lighting.lobes());
#pragma once

#include "assets/asset_store.h"
#include "systems/frame_constants.h"
#include "systems/gpu_scene.h"
#include "systems/sky_beams.h"
#include "systems/sky_lobes.h"

namespace penumbra {

// How many of `beams` each of so many environments has, dark ones counted: so nothing jumps where
// one fades in.
std::uint32_t beamShare(std::uint32_t beams, std::size_t lightCount);

class EnvironmentLighting {
public:
    // `assets` outlives it. `ground`: y < 0 is solid and dark, see aboveGround.
    // `beams` (kMaxBeams at most): how many directional lights the bright part of all environments
    // becomes; light() is what they leave. Each environment has an equal share of them (none where
    // there are more environments than beams), cut anew
    // where a map over ground is tilted.
    EnvironmentLighting(const AssetStore& assets, bool ground, std::uint32_t beams = 0)
        : m_assets(assets), m_ground(ground), m_maxBeams(beams)
    {}

    // Every light names an environment of the store (asserted). Takes 0.03 ms per light; with
    // beams as long as splitSky for a map that is new or has another share of them, over ground as
    // long as both for one that was tilted: by more than 0.006
    // degrees, a hundredth of the largest map's pixel.
    void set(std::span<const EnvironmentLight> lights);

    // The sum over the lights of intensity * rotated radiance, W/(m² sr), without beams().
    [[nodiscard]] const LightSh& light() const { return m_light; }

    // The same sum, filtered for sharp reflections. Made when asked for: 2 ms per light, and as
    // long as filterSky for a map that is new or, over ground, was tilted.
    const SkyLobes& lobes();

    [[nodiscard]] const std::vector<SkyBeam>& beams() const { return m_beams; } // world

    // The lights that are drawn: the kSkyMaps strongest, by intensity times mean luminance.
    [[nodiscard]] const std::vector<SkyMap>& background() const { return m_background; }

private:
    // A map as light, in its axes; over ground, cut at the horizon.
    struct Lit {
        AssetHandle asset;
        vec3 up{0};              // of the world, in the map's axes; 0 without ground
        std::uint32_t share = 0; // of beams, at most
        LightSh light{};         // without them
        std::vector<SkyBeam> beams;
        SkyLobes lobes; // empty until asked for
    };
    Lit& lit(const EnvironmentLight& light);

    const AssetStore& m_assets;
    bool m_ground;
    std::uint32_t m_maxBeams;
    std::uint32_t m_share = 0;              // of the beams, of each light
    std::vector<Lit> m_lit;                 // those used last are last
    std::vector<EnvironmentLight> m_lights; // those that are not dark
    LightSh m_light{};
    std::vector<SkyBeam> m_beams;
    SkyLobes m_lobes; // empty: to be made
    std::vector<SkyMap> m_background;
};

// What is kept of a light over ground, or the whole map without: for the reference.
Environment litEnvironment(const AssetStore& assets, const EnvironmentLight& light, bool ground);

} // namespace penumbra
