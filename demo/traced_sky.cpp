#include "demo/traced_sky.h"

#include "systems/environment_lighting.h"

namespace penumbra {

TracedSky tracedSky(const DemoScene& scene, std::uint32_t beams)
{
    std::size_t count = 0;
    scene.world.query<const EnvironmentLight>().each([&](const EnvironmentLight&) { ++count; });
    std::vector<ReferenceLight> maps, order4;
    scene.world.query<const EnvironmentLight>().each([&](const EnvironmentLight& light) {
        const Environment lit = litEnvironment(scene.assets, light, scene.ground());
        const mat3 rotation = rotationMatrix(light.rotation);
        maps.push_back(ReferenceLight::fromMap(lit, rotation, light.intensity));
        const SkySplit split = splitSky(lit, beamShare(beams, count));
        order4.push_back(ReferenceLight::fromSh4(split.rest.sh4, rotation, light.intensity));
        if (!split.beams.empty())
            order4.push_back(ReferenceLight::fromMap(split.bright, rotation, light.intensity));
    });
    return {ReferenceLight::sum(maps), ReferenceLight::sum(order4)};
}

} // namespace penumbra
