#include "demo/traced_sky.h"

#include "systems/environment_lighting.h"

namespace penumbra {

TracedSky tracedSky(const DemoScene& scene)
{
    std::vector<ReferenceLight> maps, order4;
    scene.world.query<const EnvironmentLight>().each([&](const EnvironmentLight& light) {
        const Environment lit = litEnvironment(scene.assets, light, scene.ground());
        const mat3 rotation = rotationMatrix(light.rotation);
        maps.push_back(ReferenceLight::fromMap(lit, rotation, light.intensity));
        order4.push_back(ReferenceLight::fromSh4(lit.sh4, rotation, light.intensity));
    });
    return {ReferenceLight::sum(maps), ReferenceLight::sum(order4)};
}

} // namespace penumbra
