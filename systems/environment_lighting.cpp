#include "systems/environment_lighting.h"

#include <algorithm>

namespace penumbra {

namespace {

constexpr float kSameUp = 1e-4f;    // radians
constexpr std::size_t kMaxLit = 16; // 2 MB each at most; a world shows few maps in turn

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

EnvironmentLighting::Lit& EnvironmentLighting::lit(const EnvironmentLight& light)
{
    const AssetHandle asset = light.asset;
    const vec3 up = m_ground ? mapUp(light) : vec3(0);
    const auto known = std::find_if(m_lit.begin(), m_lit.end(), [&](const Lit& lit) {
        return lit.asset == asset && length(lit.up - up) < kSameUp && lit.share == m_share;
    });
    if (known != m_lit.end()) {
        std::rotate(known, known + 1, m_lit.end());
        return m_lit.back();
    }
    if (m_lit.size() == kMaxLit)
        m_lit.erase(m_lit.begin());
    const Environment& whole = m_assets.environment(asset);
    SkySplit split = splitSky(m_ground ? aboveGround(whole, up) : whole, m_share);
    m_lit.push_back({asset, up, m_share, split.rest.sh6, std::move(split.beams), {}});
    return m_lit.back();
}

std::uint32_t beamShare(std::uint32_t beams, std::size_t lightCount)
{
    return lightCount == 0 ? 0 : beams / static_cast<std::uint32_t>(lightCount);
}

const SkyLobes& EnvironmentLighting::lobes()
{
    if (!m_lobes.texels.empty())
        return m_lobes;
    m_lobes.texels.resize(kSkyLobeTexels);
    for (const EnvironmentLight& light : m_lights) {
        Lit& known = lit(light);
        if (known.lobes.texels.empty()) // cuts the map again: few scenes ask, and maps are large
            known.lobes = filterSky(litEnvironment(m_assets, light, m_ground));
        addTurned(m_lobes, known.lobes, light.intensity, light.rotation);
    }
    return m_lobes;
}

void EnvironmentLighting::set(std::span<const EnvironmentLight> lights)
{
    m_light = {};
    m_beams.clear();
    m_share = beamShare(m_maxBeams, lights.size());
    m_lobes.texels.clear();
    m_lights.clear();
    std::vector<const EnvironmentLight*> drawn;
    for (const EnvironmentLight& light : lights) {
        if (light.intensity == 0)
            continue;
        const Lit& known = lit(light);
        const mat3 rotation = rotationMatrix(light.rotation);
        for (const SkyBeam& beam : known.beams)
            m_beams.push_back(
                {rotation * beam.direction, light.intensity * beam.irradiance, beam.halfAngle});
        LightSh radiance = known.light;
        if (light.rotation != vec4(0, 0, 0, 1))
            radiance = rotatedLight(radiance, rotation);
        for (std::size_t k = 0; k < radiance.size(); ++k)
            m_light[k] += light.intensity * radiance[k];
        m_lights.push_back(light);
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
