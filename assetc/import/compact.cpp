#include "assetc/import/compact.h"

#include <algorithm>

namespace penumbra {

namespace {

constexpr std::uint32_t kUnused = ~0u;

bool isAlike(SurfaceMaterial a, const SurfaceMaterial& b)
{
    a.name = b.name;
    return a == b;
}

// Place of materials[index] among `kept`, added where it is new.
std::uint32_t placeOf(const SurfaceMaterial& material, std::vector<SurfaceMaterial>& kept)
{
    const auto found = std::find_if(kept.begin(), kept.end(), [&](const SurfaceMaterial& other) {
        return isAlike(other, material);
    });
    const auto place = static_cast<std::uint32_t>(found - kept.begin());
    if (found == kept.end())
        kept.push_back(material);
    return place;
}

void compactImages(MeshAsset& mesh)
{
    std::vector<std::uint32_t> places(mesh.images.size(), kUnused);
    std::vector<MeshImage> kept;
    for (SurfaceMaterial& material : mesh.materials)
        for (std::optional<MeshTexture>& texture : material.textures) {
            if (!texture)
                continue;
            std::uint32_t& place = places[texture->image];
            if (place == kUnused) {
                place = static_cast<std::uint32_t>(kept.size());
                kept.push_back(std::move(mesh.images[texture->image]));
            }
            texture->image = place;
        }
    mesh.images = std::move(kept);
}

bool usesTexcoord(const MeshAsset& mesh, std::uint32_t set)
{
    for (const SurfaceMaterial& material : mesh.materials)
        for (const std::optional<MeshTexture>& texture : material.textures)
            if (texture && texture->texcoord == set)
                return true;
    return false;
}

} // namespace

void compactMaterials(MeshAsset& mesh, std::vector<std::uint32_t>& materialOf)
{
    std::vector<std::uint32_t> places(mesh.materials.size(), kUnused);
    std::vector<SurfaceMaterial> kept;
    for (std::uint32_t& material : materialOf) {
        if (mesh.materials.empty())
            break;
        std::uint32_t& place = places[material];
        if (place == kUnused)
            place = placeOf(mesh.materials[material], kept);
        material = place;
    }
    mesh.materials = std::move(kept);
    compactImages(mesh);
    if (!usesTexcoord(mesh, 0))
        mesh.texcoords0.clear();
    if (!usesTexcoord(mesh, 1))
        mesh.texcoords1.clear();
    const VertexColor white = {255, 255, 255, 255};
    if (std::all_of(mesh.colors.begin(), mesh.colors.end(),
                    [&](const VertexColor& color) { return color == white; }))
        mesh.colors.clear();
}

} // namespace penumbra
