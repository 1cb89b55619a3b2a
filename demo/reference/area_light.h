// Surfaces that shine, for the reference: the instances of a scene whose material emits, sampled by
// area.
#pragma once

#include "demo/reference/scene.h"

#include <vector>

namespace penumbra {

class AreaLight {
public:
    // Of the instance with this index in its scene. All of its triangles shine on the side around
    // which their vertices run counter-clockwise, double-sided ones on both: `intensity` times
    // their material's emission, times its texture, in the cone of a spot. Error: no material that
    // emits, or a texture that is no PNG.
    static Result<AreaLight> make(std::uint32_t index, const ReferenceInstance& instance,
                                  vec3 intensity);

    struct Sample {
        vec3 position{0}; // world
        std::uint32_t triangle = 0;
        vec2 barycentric{0}; // weights of the triangle's second and third corner
    };
    // Maps [0, 1)^2 to points spread evenly over the surface.
    [[nodiscard]] Sample sample(vec2 u) const;

    // Radiance that leaves the point towards the unit `direction`, W/(m² sr), and the cosine there;
    // both 0 behind the surface.
    struct Emission {
        vec3 radiance{0};
        float cosine = 0;
    };
    [[nodiscard]] Emission emission(std::uint32_t triangle, vec2 barycentric, vec3 direction) const;

    [[nodiscard]] float area() const { return m_area; } // world, m²
    [[nodiscard]] std::uint32_t instance() const { return m_instance; }

private:
    struct Triangle {
        std::array<vec3, 3> corners; // world
        std::array<vec2, 3> texcoords;
        vec3 normal; // world, unit
        std::uint32_t material = 0;
    };
    struct Surface {
        vec3 radiance{0};
        bool twoSided = false, spot = false;
        float cosInner = 1, cosOuter = 0; // of a spot
        std::uint32_t width = 0, height = 0;
        std::vector<vec3> texture; // [height][width] linear; empty: white
    };
    static Result<Surface> makeSurface(const MeshAsset& mesh, const SurfaceMaterial& material);

    std::uint32_t m_instance = kNoInstance;
    std::vector<Triangle> m_triangles;
    std::vector<Surface> m_surfaces; // by material
    std::vector<float> m_start;      // [triangle + 1] cumulative area, 0 … 1
    float m_area = 0;
};

} // namespace penumbra
