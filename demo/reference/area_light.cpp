#include "demo/reference/area_light.h"

#include "demo/image/image.h"

#include <algorithm>

namespace penumbra {

Result<AreaLight> AreaLight::make(std::uint32_t index, const ReferenceInstance& instance,
                                  vec3 intensity)
{
    const MeshAsset& mesh = *instance.mesh;
    AreaLight light;
    light.m_instance = index;
    for (const SurfaceMaterial& material : mesh.materials) {
        Result<Surface> surface = makeSurface(mesh, material);
        if (!surface)
            return fail(surface.error(), mesh.name);
        surface->radiance *= intensity;
        light.m_surfaces.push_back(std::move(*surface));
    }
    const bool shines =
        std::any_of(light.m_surfaces.begin(), light.m_surfaces.end(), [](const Surface& surface) {
            return surface.radiance.r + surface.radiance.g + surface.radiance.b > 0;
        });
    if (!shines && intensity != vec3(0))
        return Error{mesh.name + ": has no material that emits; compile it with assetc light"};
    double area = 0;
    std::vector<double> start{0};
    for (const Submesh& submesh : submeshesOf(mesh)) {
        if (submesh.material >= light.m_surfaces.size())
            return Error{mesh.name + ": has no material that emits; compile it with assetc light"};
        for (std::uint32_t i = 0; i < submesh.indexCount; i += 3) {
            Triangle triangle;
            triangle.material = submesh.material;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t v = mesh.indices[submesh.firstIndex + i + k];
                triangle.corners[k] = vec3(instance.worldFromObject * vec4(mesh.positions[v], 1));
                triangle.texcoords[k] = mesh.texcoords0.empty() ? vec2(0) : mesh.texcoords0[v];
            }
            const vec3 normal = cross(triangle.corners[1] - triangle.corners[0],
                                      triangle.corners[2] - triangle.corners[0]);
            area += 0.5 * static_cast<double>(length(normal));
            triangle.normal = normalize(normal);
            start.push_back(area);
            light.m_triangles.push_back(triangle);
        }
    }
    light.m_area = static_cast<float>(area);
    for (const double s : start)
        light.m_start.push_back(static_cast<float>(s / area));
    return light;
}

Result<AreaLight::Surface> AreaLight::makeSurface(const MeshAsset& mesh,
                                                  const SurfaceMaterial& material)
{
    Surface surface;
    surface.radiance = material.emissive;
    surface.twoSided = material.doubleSided;
    surface.spot = material.emissionCone.y > 0;
    if (surface.spot) {
        surface.cosInner = std::cos(material.emissionCone.x);
        surface.cosOuter = std::cos(material.emissionCone.y);
    }
    const std::optional<MeshTexture>& texture = material.textures[kEmissiveTexture];
    if (!texture)
        return surface;
    const Result<Image8> image = decodePng(mesh.images[texture->image].bytes);
    if (!image)
        return image.error();
    surface.width = image->width;
    surface.height = image->height;
    for (std::size_t i = 0; i < image->rgba.size(); i += 4) {
        vec3 pixel;
        for (std::size_t c = 0; c < 3; ++c)
            pixel[static_cast<int>(c)] =
                linearFromSrgb(static_cast<float>(image->rgba[i + c]) / 255.0f);
        surface.texture.push_back(pixel);
    }
    return surface;
}

AreaLight::Sample AreaLight::sample(vec2 u) const
{
    const auto after = std::upper_bound(m_start.begin() + 1, m_start.end() - 1, u.x);
    const auto triangle = static_cast<std::size_t>(after - m_start.begin()) - 1;
    const float low = m_start[triangle], high = m_start[triangle + 1];
    const float x = clamp((u.x - low) / max(high - low, 1e-30f), 0.0f, 1.0f);
    // The square folded onto the triangle keeps neighbours neighbours.
    vec2 b = x + u.y <= 1.0f ? vec2(x, u.y) : vec2(1.0f - u.y, 1.0f - x);
    const std::array<vec3, 3>& p = m_triangles[triangle].corners;
    return {(1.0f - b.x - b.y) * p[0] + b.x * p[1] + b.y * p[2],
            static_cast<std::uint32_t>(triangle), b};
}

AreaLight::Emission AreaLight::emission(std::uint32_t index, vec2 b, vec3 direction) const
{
    const Triangle& triangle = m_triangles[index];
    const Surface& surface = m_surfaces[triangle.material];
    const float along = dot(triangle.normal, direction);
    const float cosine = surface.twoSided ? abs(along) : along;
    if (cosine <= 0.0f)
        return {};
    vec3 radiance = surface.radiance;
    if (!surface.texture.empty()) {
        const std::array<vec2, 3>& t = triangle.texcoords;
        const vec2 uv = (1.0f - b.x - b.y) * t[0] + b.x * t[1] + b.y * t[2];
        const auto pixel = [](float at, std::uint32_t side) {
            return std::min(
                static_cast<std::uint32_t>(clamp(at, 0.0f, 1.0f) * static_cast<float>(side)),
                side - 1);
        };
        radiance *= surface.texture[std::size_t{pixel(uv.y, surface.height)} * surface.width +
                                    pixel(uv.x, surface.width)];
    }
    if (surface.spot) { // intensity I(a) of KHR_lights_punctual, over the cosine
        const float t =
            clamp((cosine - surface.cosOuter) / (surface.cosInner - surface.cosOuter), 0.0f, 1.0f);
        radiance *= t * t / cosine;
    }
    return {radiance, cosine};
}

} // namespace penumbra
