#include "assetc/light/surface.h"

#include "assetc/sheet/png.h"

#include <algorithm>
#include <numbers>

namespace penumbra {

namespace {

constexpr std::uint32_t kMaxTextureSide = 256; // as FlatEmitter averages it

// Box-filtered to at most kMaxTextureSide.
LightPicture filtered(const LightPicture& picture)
{
    LightPicture small{
        std::min(picture.width, kMaxTextureSide), std::min(picture.height, kMaxTextureSide), {}};
    for (std::uint32_t y = 0; y < small.height; ++y)
        for (std::uint32_t x = 0; x < small.width; ++x) {
            const std::uint32_t x0 = x * picture.width / small.width,
                                x1 = (x + 1) * picture.width / small.width;
            const std::uint32_t y0 = y * picture.height / small.height,
                                y1 = (y + 1) * picture.height / small.height;
            glm::dvec3 sum(0);
            for (std::uint32_t j = y0; j < y1; ++j)
                for (std::uint32_t i = x0; i < x1; ++i)
                    sum += picture.pixels[std::size_t{j} * picture.width + i];
            small.pixels.emplace_back(sum / (static_cast<double>(x1 - x0) * (y1 - y0)));
        }
    return small;
}

} // namespace

float paintLight(MeshAsset& mesh, const LightSpec& spec, const LightPicture* picture)
{
    if (mesh.materials.empty())
        mesh.materials.resize(1);
    if (mesh.submeshes.empty())
        mesh.submeshes = {{0, static_cast<std::uint32_t>(mesh.indices.size()), 0,
                           static_cast<std::uint32_t>(mesh.positions.size()), 0}};
    for (SurfaceMaterial& material : mesh.materials) {
        material.textures[kEmissiveTexture].reset(); // a light emits alike everywhere …
        material.doubleSided = spec.shape == EmitterShape::Mesh && spec.twoSided;
        if (spec.shape == EmitterShape::Spot)
            material.emissionCone =
                vec2(spec.innerAngle, spec.outerAngle) * (std::numbers::pi_v<float> / 180);
    }
    if (picture == nullptr) {
        if (spec.shape != EmitterShape::Mesh)
            mesh.texcoords0.clear(); // nothing uses them
        return 1;
    }
    const LightPicture small = filtered(*picture);
    float white = 1e-6f;
    for (const vec3& pixel : small.pixels)
        white = std::max({white, pixel.r, pixel.g, pixel.b});
    Canvas canvas(static_cast<int>(small.width), static_cast<int>(small.height));
    for (std::uint32_t y = 0; y < small.height; ++y)
        for (std::uint32_t x = 0; x < small.width; ++x)
            canvas.at(static_cast<int>(x), static_cast<int>(y)) =
                displayColor(small.pixels[std::size_t{y} * small.width + x] / white);
    mesh.images.push_back({ImageType::Png, encodePng(canvas)});
    MeshTexture texture;                   // … but for its picture
    texture.wrapS = texture.wrapT = 33071; // clamped: the edges do not blend into each other
    mesh.materials.front().textures[kEmissiveTexture] = texture;
    return white;
}

void setEmission(MeshAsset& mesh, vec3 radiance)
{
    for (SurfaceMaterial& material : mesh.materials)
        material.emissive = radiance;
}

} // namespace penumbra
