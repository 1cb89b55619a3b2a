#include "demo/surface_picture.h"

#include <algorithm>

namespace penumbra {

namespace {

Result<std::vector<vec3>> drawWith(Renderer& renderer, const View& view, float radiance)
{
    const std::vector<vec4> all(renderer.radianceCount(), vec4(vec3(radiance), 1));
    if (Result<void> set = renderer.setRadiance(all); !set)
        return set.error();
    if (Result<void> drawn = renderer.drawFrame(view, Kernel::Exact, false); !drawn)
        return drawn.error();
    return renderer.linearPicture();
}

} // namespace

Result<SurfacePicture> drawSurfaces(Renderer& renderer, const View& view)
{
    const SceneData& data = renderer.scene().data();
    SurfacePicture surfaces;
    for (const SceneInstance& instance : data.instances)
        surfaces.painted.push_back(!data.meshes[instance.mesh].surface.plain());
    if (std::find(surfaces.painted.begin(), surfaces.painted.end(), true) == surfaces.painted.end())
        return SurfacePicture{};
    Result<std::vector<vec3>> black = drawWith(renderer, view, 0);
    Result<std::vector<vec3>> white = drawWith(renderer, view, 1);
    if (!black || !white)
        return black ? white.error() : black.error();
    surfaces.emission = std::move(*black);
    surfaces.color = std::move(*white);
    for (std::size_t i = 0; i < surfaces.color.size(); ++i)
        surfaces.color[i] -= surfaces.emission[i];
    return surfaces;
}

void paintSurfaces(const SurfacePicture& surfaces, ReferencePicture& picture)
{
    for (std::size_t i = 0; i < picture.instance.size(); ++i) {
        const std::uint32_t instance = picture.instance[i];
        if (instance >= surfaces.painted.size() || !surfaces.painted[instance])
            continue; // background, plain, or a light's surface that is no instance of the frame
        for (std::vector<vec3>* radiance :
             {&picture.radiance.shadowed, &picture.radiance.unshadowed})
            (*radiance)[i] =
                surfaces.color[i] * ((*radiance)[i] - picture.emission[i]) + surfaces.emission[i];
    }
}

} // namespace penumbra
