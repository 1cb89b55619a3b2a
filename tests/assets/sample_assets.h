// Small assets for codec tests: a bumpy sphere of given detail with made-up self-visibility and a
// made-up field.
#pragma once

#include "assets/mesh_asset.h"

#include <random>

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

inline MeshAsset sampleAsset(std::uint32_t rings = 8)
{
    MeshAsset mesh = sampleMesh(rings);
    mesh.field = sampleField();
    return mesh;
}

} // namespace penumbra
