#include "systems/environment_lighting.h"

#include <algorithm>

namespace penumbra {

namespace {

constexpr float kSameUp = 1e-4f;     // radians
constexpr std::size_t kMaxCuts = 16; // 0.5 KB each; a world shows few maps in turn

// The world's +y in the map's axes.
vec3 mapUp(const EnvironmentLight& light)
{
    return rotate(vec4(-vec3(light.rotation), light.rotation.w), vec3(0, 1, 0));
}

float strength(const AssetStore& assets, const EnvironmentLight& light)
{
    return light.intensity * assets.environment(light.asset).statistics.meanLuminance;
}

} // namespace

const LightSh& EnvironmentLighting::lightOf(AssetHandle asset, vec3 up)
{
    const Environment& environment = m_assets.environment(asset);
    if (!m_ground)
        return environment.sh6;
    const auto known = std::find_if(m_cuts.begin(), m_cuts.end(), [&](const Cut& cut) {
        return cut.asset == asset && length(cut.up - up) < kSameUp;
    });
    if (known != m_cuts.end()) {
        std::rotate(known, known + 1, m_cuts.end());
    } else {
        if (m_cuts.size() == kMaxCuts)
            m_cuts.erase(m_cuts.begin());
        m_cuts.push_back({asset, up, aboveGround(environment, up).sh6});
    }
    return m_cuts.back().light;
}

void EnvironmentLighting::set(std::span<const EnvironmentLight> lights)
{
    m_light = {};
    std::vector<const EnvironmentLight*> drawn;
    for (const EnvironmentLight& light : lights) {
        if (light.intensity == 0)
            continue;
        LightSh radiance = lightOf(light.asset, mapUp(light));
        if (light.rotation != vec4(0, 0, 0, 1))
            radiance = rotatedLight(radiance, rotationMatrix(light.rotation));
        for (std::size_t k = 0; k < radiance.size(); ++k)
            m_light[k] += light.intensity * radiance[k];
        drawn.push_back(&light);
    }
    if (drawn.size() > kSkyMaps) {
        std::vector<const EnvironmentLight*> strongest = drawn;
        std::stable_sort(strongest.begin(), strongest.end(), [&](const auto* a, const auto* b) {
            return strength(m_assets, *a) > strength(m_assets, *b);
        });
        strongest.resize(kSkyMaps);
        // In the order of the lights, whichever is stronger: floats add up to the same.
        std::erase_if(drawn, [&](const auto* light) {
            return std::find(strongest.begin(), strongest.end(), light) == strongest.end();
        });
    }
    m_background.clear();
    for (const EnvironmentLight* light : drawn) {
        SkyMap sky = m_assets.environment(light->asset);
        sky.intensity = light->intensity;
        sky.rotation = light->rotation;
        m_background.push_back(sky);
    }
}

Environment litEnvironment(const AssetStore& assets, const EnvironmentLight& light, bool ground)
{
    const Environment& environment = assets.environment(light.asset);
    return ground ? aboveGround(environment, mapUp(light)) : environment;
}

} // namespace penumbra
