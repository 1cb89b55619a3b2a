// Small assets for codec tests: a bumpy sphere of given detail with made-up self-visibility and a
// made-up field.
#pragma once

#include "assets/mesh_asset.h"

#include <random>
#include <string_view>

namespace penumbra {

// Latitude-longitude sphere of about rings * 2 * rings vertices, closed, counter-clockwise outside.
inline MeshAsset sampleMesh(std::uint32_t rings = 8)
{
    MeshAsset mesh;
    mesh.name = "bumpy";
    mesh.material = {{0.5f, 0.25f, 1.0f}, 0.2f, 30.0f};
    const std::uint32_t sectors = 2 * rings;
    const auto add = [&](float theta, float phi) {
        const vec3 direction{sin(theta) * cos(phi), cos(theta), sin(theta) * sin(phi)};
        mesh.positions.push_back((1.0f + 0.1f * pow(sin(theta), 3.0f) * cos(3 * phi)) * direction);
        mesh.normals.push_back(direction);
    };
    add(0, 0);
    for (std::uint32_t r = 1; r < rings; ++r)
        for (std::uint32_t s = 0; s < sectors; ++s)
            add(3.14159265f * static_cast<float>(r) / static_cast<float>(rings),
                6.28318531f * static_cast<float>(s) / static_cast<float>(sectors));
    add(3.14159265f, 0);
    const auto vertex = [&](std::uint32_t r, std::uint32_t s) {
        if (r == 0)
            return 0u;
        if (r == rings)
            return static_cast<std::uint32_t>(mesh.positions.size()) - 1;
        return 1 + (r - 1) * sectors + s % sectors;
    };
    for (std::uint32_t r = 0; r < rings; ++r)
        for (std::uint32_t s = 0; s < sectors; ++s) {
            if (r + 1 < rings)
                mesh.indices.insert(mesh.indices.end(),
                                    {vertex(r, s), vertex(r + 1, s + 1), vertex(r + 1, s)});
            if (r > 0)
                mesh.indices.insert(mesh.indices.end(),
                                    {vertex(r, s), vertex(r, s + 1), vertex(r + 1, s + 1)});
        }
    std::mt19937 random(7);
    mesh.selfVisibility.resize(mesh.positions.size());
    for (SelfVisibility& visibility : mesh.selfVisibility)
        for (std::uint8_t& value : visibility)
            value = static_cast<std::uint8_t>(random());
    updateDerived(mesh);
    return mesh;
}

// Two shells with every byte value in them.
inline ShadowField sampleField()
{
    ShadowField field;
    field.center = {0.1f, -0.2f, 0.3f};
    field.radius = 1.25f;
    field.bandScale = {0.1f, 0.2f, 0.3f, 0.4f};
    field.shellSides = {5, 3};
    field.directions = 1024;
    field.texels.resize(fieldTexelBytes(field));
    for (std::size_t i = 0; i < field.texels.size(); ++i)
        field.texels[i] = static_cast<std::uint8_t>(i * 37);
    return field;
}

inline MeshImage sampleImage(ImageType type, std::size_t size, std::uint32_t seed)
{
    std::mt19937 random(seed);
    MeshImage image{type, std::vector<std::byte>(size)};
    for (std::byte& byte : image.bytes)
        byte = static_cast<std::byte>(random());
    const std::string_view magic = type == ImageType::Png ? "\x89PNG\r\n\x1a\n" : "\xff\xd8\xff";
    for (std::size_t i = 0; i < magic.size(); ++i)
        image.bytes[i] = static_cast<std::byte>(magic[i]);
    return image;
}

// Every member in use: two submeshes, textures, colours, lights, an LOD.
inline MeshAsset sampleScene()
{
    MeshAsset mesh = sampleMesh(5);
    const MeshAsset other = sampleMesh(4);
    const auto firstVertices = static_cast<std::uint32_t>(mesh.positions.size());
    const auto firstIndices = static_cast<std::uint32_t>(mesh.indices.size());
    for (std::size_t i = 0; i < other.positions.size(); ++i) {
        mesh.positions.push_back(other.positions[i] * 0.5f + vec3(2, 0, 0));
        mesh.normals.push_back(other.normals[i]);
        mesh.selfVisibility.push_back(other.selfVisibility[i]);
    }
    for (const std::uint32_t index : other.indices)
        mesh.indices.push_back(firstVertices + index);
    mesh.submeshes = {{0, firstIndices, 0, firstVertices, 1},
                      {firstIndices, static_cast<std::uint32_t>(other.indices.size()),
                       firstVertices, static_cast<std::uint32_t>(other.positions.size()), 0}};
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const vec3 p = mesh.positions[i];
        mesh.texcoords0.emplace_back(p.x, 1 - p.y);
        mesh.texcoords1.emplace_back(9 * p.z, 0.25f);
        mesh.colors.push_back({static_cast<std::uint8_t>(i), 3, 200, 255});
    }
    mesh.images = {sampleImage(ImageType::Png, 301, 3), sampleImage(ImageType::Jpeg, 77, 4)};
    SurfaceMaterial plain{{{0.1f, 0.2f, 0.3f}, 0, 0}};
    plain.name = "plain";
    SurfaceMaterial rich{{{0.5f, 0.25f, 1.0f}, 0.2f, 30.0f}};
    rich.name = "rich";
    rich.alpha = 0.5f;
    rich.metallic = 0.75f;
    rich.roughness = 0.125f;
    rich.emissive = {0, 0.5f, 1};
    rich.alphaMode = AlphaMode::Mask;
    rich.alphaCutoff = 0.25f;
    rich.doubleSided = true;
    rich.normalScale = -2;
    rich.occlusionStrength = 0.5f;
    rich.textures[kBaseColorTexture] = {.image = 1, .wrapS = 33071, .magFilter = 9728};
    rich.textures[kMetallicRoughnessTexture] = {.image = 0, .minFilter = 9987};
    rich.textures[kNormalTexture] = {.image = 0, .texcoord = 1};
    rich.textures[kOcclusionTexture] = {
        .image = 0, .offset = {0.5f, 0.25f}, .scale = {2, -1}, .rotation = 0.5f};
    rich.textures[kEmissiveTexture] = {.image = 1};
    mesh.materials = {plain, rich};
    MeshLight sun{LightType::Directional, "sun"};
    sun.direction = {0, -1, 0};
    MeshLight lamp{LightType::Spot, "lamp", {1, 0.5f, 0}, 40, 12, 0.25f, 0.5f, {1, 2, 3}};
    lamp.direction = {0, 0, 1};
    MeshLight bulb{LightType::Point};
    bulb.position = {-1, 0, 0};
    mesh.lights = {sun, lamp, bulb};
    MeshLod lod;
    static_cast<MeshGeometry&>(lod) = mesh;
    lod.error = 0.125f; // the second submesh loses its last triangle
    lod.indices.resize(lod.indices.size() - 3);
    lod.submeshes[1].indexCount -= 3;
    mesh.lods = {lod};
    mesh.field = sampleField();
    updateDerived(mesh);
    return mesh;
}

inline MeshAsset sampleAsset(std::uint32_t rings = 8)
{
    MeshAsset mesh = sampleMesh(rings);
    mesh.field = sampleField();
    return mesh;
}

} // namespace penumbra
