#include "assetc/light/surface.h"

#include "assetc/sheet/png.h"

#include <algorithm>
#include <numbers>

namespace penumbra {

namespace {

constexpr std::uint32_t kMaxTextureSide = 256; // as FlatEmitter averages it

// Box-filtered to at most kMaxTextureSide, divided by `white`.
Canvas textureOf(const LightPicture& picture, float white)
{
    const std::uint32_t width = std::min(picture.width, kMaxTextureSide);
    const std::uint32_t height = std::min(picture.height, kMaxTextureSide);
    Canvas canvas(static_cast<int>(width), static_cast<int>(height));
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const std::uint32_t x0 = x * picture.width / width,
                                x1 = (x + 1) * picture.width / width;
            const std::uint32_t y0 = y * picture.height / height,
                                y1 = (y + 1) * picture.height / height;
            glm::dvec3 sum(0);
            for (std::uint32_t j = y0; j < y1; ++j)
                for (std::uint32_t i = x0; i < x1; ++i)
                    sum += picture.pixels[std::size_t{j} * picture.width + i];
            const double pixels = static_cast<double>(x1 - x0) * (y1 - y0);
            canvas.at(static_cast<int>(x), static_cast<int>(y)) =
                displayColor(vec3(sum / (pixels * white)));
        }
    return canvas;
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
        material.doubleSided = false;
        if (spec.shape == EmitterShape::Spot)
            material.emissionCone =
                vec2(spec.innerAngle, spec.outerAngle) * (std::numbers::pi_v<float> / 180);
    }
    if (picture == nullptr) {
        if (spec.shape != EmitterShape::Mesh)
            mesh.texcoords0.clear(); // nothing uses them
        return 1;
    }
    float white = 1e-6f;
    for (const vec3& pixel : picture->pixels)
        white = std::max({white, pixel.r, pixel.g, pixel.b});
    mesh.images.push_back({ImageType::Png, encodePng(textureOf(*picture, white))});
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
