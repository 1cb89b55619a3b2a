// A square of two triangles that fills the picture, to see textures where they are.
#pragma once

#include "assets/mesh_asset.h"
#include "demo/image/image.h"

namespace penumbra {

// Sides of 2 m in the plane z = 0 around the origin, looking along +z; the picture of a texture
// covers it, its row 0 on top.
inline MeshAsset makeQuad()
{
    MeshAsset mesh;
    mesh.name = "quad";
    for (const vec2 p : {vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, 1)}) {
        mesh.positions.emplace_back(p, 0);
        mesh.normals.emplace_back(0, 0, 1);
        mesh.texcoords0.push_back(vec2(0.5f + 0.5f * p.x, 0.5f - 0.5f * p.y));
        mesh.selfVisibility.emplace_back().fill(128);
    }
    mesh.indices = {0, 1, 2, 0, 2, 3};
    mesh.materials.emplace_back();
    mesh.materials[0].albedo = vec3(1);
    updateDerived(mesh);
    return mesh;
}

// Colours row by row from the top, each a square of `block` pixels.
inline MeshImage makePng(std::uint32_t columns, std::uint32_t block,
                         const std::vector<std::array<std::uint8_t, 4>>& colors)
{
    const auto rows = static_cast<std::uint32_t>(colors.size()) / columns;
    Image8 image = makeImage(columns * block, rows * block);
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x)
            for (std::size_t c = 0; c < 4; ++c)
                image.rgba[4 * (std::size_t{y} * image.width + x) + c] =
                    colors[y / block * columns + x / block][c];
    return {ImageType::Png, encodePng(image)};
}

// The texture of a slot of material 0, by texture coordinates 0.
inline void setTexture(MeshAsset& mesh, TextureSlot slot, MeshImage image)
{
    mesh.materials[0].textures[slot] =
        MeshTexture{.image = static_cast<std::uint32_t>(mesh.images.size())};
    mesh.images.push_back(std::move(image));
}

} // namespace penumbra
