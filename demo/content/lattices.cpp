// Shapes over a lattice: the rounded cube and the floor.
#include "demo/content/mesh_builder.h"
#include "demo/content/shapes.h"

#include <glm/gtc/constants.hpp>
#include <map>
#include <tuple>

namespace penumbra {

// The superellipsoid x^5 + y^5 + z^5 = 1 (absolute values). Lattice points on a cube's surface are
// pushed out along their rays; tan spacing (the equiangular cube map) keeps the cells alike.
ContentMesh makeRoundedCube()
{
    constexpr int kCells = 26;
    constexpr float kHalfWidth = 0.15f, kExponent = 5;
    MeshBuilder builder;
    std::map<std::tuple<int, int, int>, std::uint32_t> vertices;
    const auto vertexAt = [&](ivec3 p) {
        const auto [found, isNew] = vertices.try_emplace({p.x, p.y, p.z}, 0u);
        if (isNew) {
            vec3 ray;
            float sum = 0;
            for (int k = 0; k < 3; ++k) {
                const float s = 2 * static_cast<float>(p[k]) / kCells - 1;
                ray[k] = std::tan(glm::quarter_pi<float>() * s);
                sum += pow(abs(ray[k]), kExponent);
            }
            found->second = builder.addVertex(kHalfWidth * ray / pow(sum, 1 / kExponent));
        }
        return found->second;
    };
    for (int axis = 0; axis < 3; ++axis) {
        for (const int side : {0, kCells}) {
            const auto at = [&](int u, int v) {
                ivec3 p;
                p[axis] = side;
                p[(axis + 1) % 3] =
                    side == 0 ? v : u; // swapped: the opposite face turns the other way
                p[(axis + 2) % 3] = side == 0 ? u : v;
                return vertexAt(p);
            };
            for (int u = 0; u < kCells; ++u) {
                for (int v = 0; v < kCells; ++v) {
                    builder.addTriangle(at(u, v), at(u + 1, v), at(u + 1, v + 1));
                    builder.addTriangle(at(u, v), at(u + 1, v + 1), at(u, v + 1));
                }
            }
        }
    }
    return builder.finish("rounded_cube", 40);
}

ContentMesh makePanel()
{
    // A floor of its own, stood up: its top looks along +z.
    ContentMesh mesh =
        makeFloor({.width = 0.96f, .depth = 0.6f, .thickness = 0.02f, .cellsX = 16, .cellsZ = 10});
    mesh.name = "panel";
    for (vec3& p : mesh.positions)
        p = vec3(p.x, -p.z, p.y - 0.001f);
    for (vec3& n : mesh.normals)
        n = vec3(n.x, -n.z, n.y);
    return mesh;
}

// The sides are one quad high and the bottom a fan around its middle: no receiver looks at them
// closely.
ContentMesh makeFloor(const FloorShape& shape)
{
    PENUMBRA_ASSERT(shape.width > 0 && shape.depth > 0 && shape.thickness > 0 && shape.cellsX > 0 &&
                        shape.cellsZ > 0,
                    "floor {} x {} x {} m, {} x {} cells", shape.width, shape.thickness,
                    shape.depth, shape.cellsX, shape.cellsZ);
    const int nx = shape.cellsX, nz = shape.cellsZ;
    MeshBuilder builder;
    const auto point = [&](int i, int k, float y) {
        return vec3(shape.width * (static_cast<float>(i) / static_cast<float>(nx) - 0.5f), y,
                    shape.depth * (static_cast<float>(k) / static_cast<float>(nz) - 0.5f));
    };
    for (int k = 0; k <= nz; ++k) {
        for (int i = 0; i <= nx; ++i)
            builder.addVertex(point(i, k, 0));
    }
    const auto top = [&](int i, int k) { return static_cast<std::uint32_t>(k * (nx + 1) + i); };
    for (int k = 0; k < nz; ++k) {
        for (int i = 0; i < nx; ++i) {
            builder.addTriangle(top(i, k), top(i, k + 1), top(i + 1, k + 1));
            builder.addTriangle(top(i, k), top(i + 1, k + 1), top(i + 1, k));
        }
    }

    std::vector<ivec2> edge; // once around, counter-clockwise seen from above
    for (int k = 0; k < nz; ++k)
        edge.push_back({0, k});
    for (int i = 0; i < nx; ++i)
        edge.push_back({i, nz});
    for (int k = nz; k > 0; --k)
        edge.push_back({nx, k});
    for (int i = nx; i > 0; --i)
        edge.push_back({i, 0});
    std::vector<std::uint32_t> bottom;
    for (const ivec2 at : edge)
        bottom.push_back(builder.addVertex(point(at.x, at.y, -shape.thickness)));
    const std::uint32_t middle = builder.addVertex(vec3(0, -shape.thickness, 0));
    for (std::size_t e = 0; e < edge.size(); ++e) {
        const std::size_t f = (e + 1) % edge.size();
        const std::uint32_t a = top(edge[e].x, edge[e].y), b = top(edge[f].x, edge[f].y);
        builder.addTriangle(a, bottom[e], bottom[f]);
        builder.addTriangle(a, bottom[f], b);
        builder.addTriangle(bottom[f], bottom[e], middle);
    }
    return builder.finish("floor", 40, MeshBuilder::Origin::AsBuilt);
}

ContentMesh makeCoarseFloor()
{
    ContentMesh mesh = makeFloor({.cellsX = 1, .cellsZ = 1});
    mesh.name = "floor_coarse";
    return mesh;
}

} // namespace penumbra
