#include "assets/mesh_asset.h"

#include <algorithm>

namespace penumbra {

namespace {

Result<void> checkSubmeshes(const MeshGeometry& geometry, std::size_t materialCount)
{
    std::uint64_t nextIndex = 0;
    std::uint64_t nextVertex = 0;
    const std::vector<Submesh> parts = submeshesOf(geometry);
    for (std::size_t s = 0; s < parts.size(); ++s) {
        const Submesh& part = parts[s];
        if (part.firstIndex != nextIndex || part.firstVertex != nextVertex ||
            part.indexCount % 3 != 0 || part.indexCount == 0 || part.vertexCount == 0 ||
            part.indexCount > geometry.indices.size() - nextIndex ||
            part.vertexCount > geometry.positions.size() - nextVertex)
            return Error{fmt::format(
                "submesh {}: {} indices from {} and {} vertices from {} do not follow the one "
                "before within {} and {}",
                s, part.indexCount, part.firstIndex, part.vertexCount, part.firstVertex,
                geometry.indices.size(), geometry.positions.size())};
        nextIndex += part.indexCount;
        nextVertex += part.vertexCount;
        for (std::uint64_t i = part.firstIndex; i < nextIndex; ++i)
            if (geometry.indices[i] < part.firstVertex || geometry.indices[i] >= nextVertex)
                return Error{fmt::format("submesh {}: triangle {} uses vertex {}, beyond {} to {}",
                                         s, i / 3, geometry.indices[i], part.firstVertex,
                                         nextVertex - 1)};
        if (part.material >= std::max<std::size_t>(materialCount, 1))
            return Error{
                fmt::format("submesh {}: material {} of {}", s, part.material, materialCount)};
    }
    if (nextIndex != geometry.indices.size() || nextVertex != geometry.positions.size())
        return Error{fmt::format("submeshes cover {} of {} indices and {} of {} vertices",
                                 nextIndex, geometry.indices.size(), nextVertex,
                                 geometry.positions.size())};
    return {};
}

Result<void> checkTexcoords(const std::vector<vec2>& texcoords)
{
    for (std::size_t i = 0; i < texcoords.size(); ++i) {
        const vec2 uv = abs(texcoords[i]);
        if (!(uv.x <= kMaxTextureNumber && uv.y <= kMaxTextureNumber))
            return Error{fmt::format("vertex {}: a texture coordinate beyond {} or not finite", i,
                                     kMaxTextureNumber)};
    }
    return {};
}

Result<void> checkGeometry(const MeshGeometry& mesh, std::size_t materialCount)
{
    const std::size_t vertexCount = mesh.positions.size();
    if (vertexCount == 0 || mesh.indices.empty())
        return Error{"no triangles"};
    if (vertexCount > kMaxMeshVertices || mesh.indices.size() / 3 > kMaxMeshTriangles)
        return Error{fmt::format("{} vertices and {} triangles, above the limits of {} and {}",
                                 vertexCount, mesh.indices.size() / 3, kMaxMeshVertices,
                                 kMaxMeshTriangles)};
    if (mesh.indices.size() % 3 != 0)
        return Error{fmt::format("{} indices are not whole triangles", mesh.indices.size())};
    if (mesh.normals.size() != vertexCount || mesh.selfVisibility.size() != vertexCount)
        return Error{fmt::format("{} positions, {} normals, {} self-visibilities", vertexCount,
                                 mesh.normals.size(), mesh.selfVisibility.size())};
    for (const std::size_t size :
         {mesh.texcoords0.size(), mesh.texcoords1.size(), mesh.colors.size()})
        if (size != 0 && size != vertexCount)
            return Error{fmt::format("{} texture coordinates or colours for {} vertices", size,
                                     vertexCount)};
    for (std::size_t i = 0; i < mesh.indices.size(); ++i)
        if (mesh.indices[i] >= vertexCount)
            return Error{fmt::format("triangle {} uses vertex {} of {}", i / 3, mesh.indices[i],
                                     vertexCount)};
    for (std::size_t i = 0; i < vertexCount; ++i) {
        const vec3 p = abs(mesh.positions[i]);
        if (!(p.x <= kMaxCoordinate && p.y <= kMaxCoordinate && p.z <= kMaxCoordinate))
            return Error{fmt::format("vertex {}: a coordinate beyond {} m or not finite", i,
                                     kMaxCoordinate)};
        const float squared = dot(mesh.normals[i], mesh.normals[i]);
        if (!(squared > 0.98f && squared < 1.02f))
            return Error{fmt::format("vertex {}: normal of length {}", i, std::sqrt(squared))};
    }
    for (const auto* texcoords : {&mesh.texcoords0, &mesh.texcoords1})
        if (const auto checked = checkTexcoords(*texcoords); !checked)
            return checked;
    return checkSubmeshes(mesh, materialCount);
}

Result<void> checkMaterial(const MeshMaterial& material)
{
    for (int channel = 0; channel < 3; ++channel)
        if (!(material.albedo[channel] >= 0 && material.albedo[channel] <= 1))
            return Error{fmt::format("albedo {}, allowed 0 to 1", material.albedo[channel])};
    if (!(material.glossFraction >= 0 && material.glossFraction <= 1))
        return Error{fmt::format("gloss fraction {}, allowed 0 to 1", material.glossFraction)};
    if (!(material.glossExponent >= 0 && material.glossExponent <= kMaxGlossExponent))
        return Error{fmt::format("gloss exponent {}, allowed 0 to {}", material.glossExponent,
                                 kMaxGlossExponent)};
    return {};
}

Result<void> checkTexture(const MeshTexture& texture, const MeshAsset& mesh)
{
    if (texture.image >= mesh.images.size())
        return Error{fmt::format("image {} of {}", texture.image, mesh.images.size())};
    if (texture.texcoord > 1 || (texture.texcoord == 0 ? mesh.texcoords0 : mesh.texcoords1).empty())
        return Error{fmt::format("texture coordinates {}, which the mesh lacks", texture.texcoord)};
    const auto isWrap = [](std::uint32_t v) { return v == 10497 || v == 33071 || v == 33648; };
    const auto isFilter = [](std::uint32_t v) { return v == 0 || v == 9728 || v == 9729; };
    if (!isWrap(texture.wrapS) || !isWrap(texture.wrapT) || !isFilter(texture.magFilter) ||
        !(isFilter(texture.minFilter) || (texture.minFilter >= 9984 && texture.minFilter <= 9987)))
        return Error{fmt::format("sampler of wrap {} and {}, filters {} and {}", texture.wrapS,
                                 texture.wrapT, texture.magFilter, texture.minFilter)};
    for (const float number :
         {texture.offset.x, texture.offset.y, texture.scale.x, texture.scale.y, texture.rotation})
        if (!(std::abs(number) <= kMaxTextureNumber))
            return Error{fmt::format("transform with {}", number)};
    return {};
}

Result<void> checkSurface(const SurfaceMaterial& material, const MeshAsset& mesh)
{
    if (const auto checked = checkMaterial(material); !checked)
        return checked;
    for (const float factor :
         {material.alpha, material.metallic, material.roughness, material.occlusionStrength})
        if (!(factor >= 0 && factor <= 1))
            return Error{fmt::format("a factor of {}, allowed 0 to 1", factor)};
    for (int c = 0; c < 3; ++c)
        if (!(material.emissive[c] >= 0 && material.emissive[c] <= kMaxEmissive))
            return Error{fmt::format("an emission of {}, allowed 0 to {}", material.emissive[c],
                                     kMaxEmissive)};
    if (const vec2 cone = material.emissionCone;
        cone != vec2(0) && !(cone.x >= 0 && cone.y <= kMaxEmissionAngle &&
                             std::cos(cone.x) - std::cos(cone.y) > 1e-6f))
        return Error{fmt::format("an emission cone of {} to {} radians", cone.x, cone.y)};
    if (!(material.alphaCutoff >= 0 && material.alphaCutoff <= kMaxTextureNumber) ||
        !(std::abs(material.normalScale) <= kMaxTextureNumber))
        return Error{fmt::format("alpha cutoff {}, normal scale {}", material.alphaCutoff,
                                 material.normalScale)};
    if (material.name.size() > kMaxNameBytes)
        return Error{fmt::format("name of {} bytes", material.name.size())};
    for (std::size_t slot = 0; slot < material.textures.size(); ++slot)
        if (material.textures[slot])
            if (const auto checked = checkTexture(*material.textures[slot], mesh); !checked)
                return fail(checked.error(), fmt::format("texture {}", slot));
    return {};
}

Result<void> checkImages(const std::vector<MeshImage>& images)
{
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < images.size(); ++i) {
        sum += images[i].bytes.size();
        if (images[i].bytes.size() > kMaxImageBytes)
            return Error{fmt::format("image {}: {} bytes, more than {}", i, images[i].bytes.size(),
                                     kMaxImageBytes)};
        if (imageType(images[i].bytes) != images[i].type)
            return Error{fmt::format("image {}: does not begin as its type does", i)};
    }
    if (sum > kMaxImagesBytes)
        return Error{fmt::format("images of {} bytes in all, more than {}", sum, kMaxImagesBytes)};
    return {};
}

Result<void> checkLight(const MeshLight& light)
{
    constexpr float kQuarter = 1.5707964f; // half a float's step above pi / 2
    for (int c = 0; c < 3; ++c)
        if (!(light.color[c] >= 0 && light.color[c] <= 1))
            return Error{fmt::format("colour {}, allowed 0 to 1", light.color[c])};
    if (!(light.intensity >= 0 && light.intensity <= kMaxLightIntensity))
        return Error{fmt::format("intensity {}", light.intensity)};
    if (!(light.range >= 0 && light.range <= kMaxCoordinate))
        return Error{fmt::format("range {}", light.range)};
    if (!(light.innerCone >= 0 && light.innerCone < light.outerCone && light.outerCone <= kQuarter))
        return Error{fmt::format("cone from {} to {}, allowed 0 <= inner < outer <= pi / 2",
                                 light.innerCone, light.outerCone)};
    for (int c = 0; c < 3; ++c)
        if (!(std::abs(light.position[c]) <= kMaxCoordinate))
            return Error{fmt::format("position {}", light.position[c])};
    const float squared = dot(light.direction, light.direction);
    if (!(squared > 0.98f && squared < 1.02f))
        return Error{fmt::format("direction of length {}", std::sqrt(squared))};
    if (light.name.size() > kMaxNameBytes)
        return Error{fmt::format("name of {} bytes", light.name.size())};
    return {};
}

} // namespace

std::optional<ImageType> imageType(const std::vector<std::byte>& bytes)
{
    const auto startsWith = [&](std::initializer_list<unsigned> magic) {
        return bytes.size() > magic.size() &&
               std::equal(magic.begin(), magic.end(), bytes.begin(), [](unsigned m, std::byte b) {
                   return std::to_integer<unsigned>(b) == m;
               });
    };
    if (startsWith({0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'}))
        return ImageType::Png;
    if (startsWith({0xff, 0xd8, 0xff}))
        return ImageType::Jpeg;
    return std::nullopt;
}

Result<void> validateMesh(const MeshAsset& mesh)
{
    if (mesh.materials.size() > kMaxMeshMaterials || mesh.images.size() > kMaxMeshImages ||
        mesh.lights.size() > kMaxMeshLights || mesh.lods.size() > kMaxMeshLods)
        return Error{fmt::format("mesh: {} materials, {} images, {} lights, {} LODs; allowed are "
                                 "{}, {}, {}, {}",
                                 mesh.materials.size(), mesh.images.size(), mesh.lights.size(),
                                 mesh.lods.size(), kMaxMeshMaterials, kMaxMeshImages,
                                 kMaxMeshLights, kMaxMeshLods)};
    if (const auto checked = checkGeometry(mesh, mesh.materials.size()); !checked)
        return fail(checked.error(), "mesh");
    if (const auto checked = checkMaterial(mesh.material); !checked)
        return fail(checked.error(), "material");
    for (std::size_t i = 0; i < mesh.materials.size(); ++i)
        if (const auto checked = checkSurface(mesh.materials[i], mesh); !checked)
            return fail(checked.error(), fmt::format("material {}", i));
    if (const auto checked = checkImages(mesh.images); !checked)
        return checked;
    for (std::size_t i = 0; i < mesh.lights.size(); ++i)
        if (const auto checked = checkLight(mesh.lights[i]); !checked)
            return fail(checked.error(), fmt::format("light {}", i));
    for (std::size_t i = 0; i < mesh.lods.size(); ++i) {
        const MeshLod& lod = mesh.lods[i];
        if (const auto checked = checkGeometry(lod, mesh.materials.size()); !checked)
            return fail(checked.error(), fmt::format("LOD {}", i + 1));
        if (!(lod.error >= 0 && lod.error <= kMaxCoordinate))
            return Error{fmt::format("LOD {}: error of {} m", i + 1, lod.error)};
        for (const auto& [own, full] : {std::pair{lod.texcoords0.empty(), mesh.texcoords0.empty()},
                                        {lod.texcoords1.empty(), mesh.texcoords1.empty()}})
            if (own != full)
                return Error{fmt::format("LOD {}: texture coordinates unlike the mesh's", i + 1)};
    }
    if (mesh.name.size() > kMaxNameBytes)
        return Error{
            fmt::format("mesh: name of {} bytes, at most {}", mesh.name.size(), kMaxNameBytes)};
    return mesh.field ? validateField(*mesh.field) : Result<void>{};
}

} // namespace penumbra
