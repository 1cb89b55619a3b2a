// Meshes and environments that the tests of the reference share.
#pragma once

#include "assets/environment.h"
#include "assets/mesh_asset.h"
#include "shaders/shared/environment.h"

#include <numbers>
#include <random>

namespace penumbra::test {

// A unit sphere of rings x 2 rings quads; its facets lie inside by 1 - cos(pi / (2 rings)).
inline MeshAsset makeSphere(std::uint32_t rings)
{
    MeshAsset mesh;
    mesh.name = "sphere";
    const std::uint32_t columns = 2 * rings;
    for (std::uint32_t y = 0; y <= rings; ++y)
        for (std::uint32_t x = 0; x <= columns; ++x)
            mesh.positions.push_back(
                equirectDirection({static_cast<float>(x) / static_cast<float>(columns),
                                   static_cast<float>(y) / static_cast<float>(rings)}));
    mesh.normals = mesh.positions;
    for (std::uint32_t y = 0; y < rings; ++y)
        for (std::uint32_t x = 0; x < columns; ++x) {
            const std::uint32_t a = y * (columns + 1) + x, b = a + columns + 1;
            for (const std::uint32_t i : {a, a + 1, b, a + 1, b + 1, b})
                mesh.indices.push_back(i);
        }
    return mesh;
}

// The square [-1, 1]^2 in xz, looking up.
inline MeshAsset makePlane()
{
    MeshAsset mesh;
    mesh.name = "plane";
    mesh.positions = {{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}};
    mesh.normals.assign(4, vec3(0, 1, 0));
    mesh.indices = {0, 1, 2, 0, 2, 3};
    return mesh;
}

inline Environment uniformSky(vec3 radiance)
{
    return makeEnvironment(8, 4, std::vector<vec3>(32, radiance));
}

// Noise with a small bright lamp, the hard case for sampling.
inline Environment lampSky(std::uint32_t width = 64, std::uint32_t height = 32)
{
    std::mt19937 random(11);
    std::vector<vec3> map;
    for (std::uint32_t i = 0; i < width * height; ++i) {
        const auto channel = [&] { return static_cast<float>(random() % 1000) * 1e-3f; };
        const float r = channel(), g = channel(), b = channel();
        map.emplace_back(r, g, b);
    }
    map[height / 5 * width + width / 3] = vec3(900, 700, 500);
    return makeEnvironment(width, height, std::move(map));
}

inline mat4 placed(vec3 at, float scale = 1.0f)
{
    mat4 m(scale);
    m[3] = vec4(at, 1);
    return m;
}

} // namespace penumbra::test
