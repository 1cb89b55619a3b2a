// Occlusion along all lines of one direction, from one orthographic rasterisation (findings section
// 3).
//
// Lines parallel to w fall on a square grid over the bounding sphere's disc. Each keeps the
// interval [near, far] of the mesh's depths p.w. A ray from p along +w is blocked if far > p.w,
// along -w if near < p.w. Depths between count as blocked both ways only if they are: a point
// between two surfaces sees neither direction.
#pragma once

#include "shaders/shared/interop.h"

#include <cstdint>
#include <vector>

namespace penumbra {

// Points in struct-of-arrays form, unit: bounding radii, relative to the sphere's centre.
struct PointSet {
    std::vector<float> x, y, z;
    [[nodiscard]] std::size_t size() const { return x.size(); }
};

class LineSpace {
public:
    // `side`: lines across the bounding sphere.
    explicit LineSpace(std::uint32_t side);

    // Rasterises the triangles (vertices inside the unit sphere) along unit direction w.
    void rasterise(vec3 w, const PointSet& vertices, const std::vector<std::uint32_t>& indices);

    // blocked[i] bit 0: the ray from point begin + i along +w is blocked, bit 1: along -w. Returns
    // whether any is.
    bool lookUp(const PointSet& points, std::size_t begin, std::size_t count,
                std::uint8_t* blocked) const;

private:
    std::uint32_t m_side; // pixels, a multiple of 8
    vec3 m_u{0}, m_v{0}, m_w{0};
    std::vector<float> m_near,
        m_far; // [side * side + padding]; the pixel after the last row is a line that hits nothing
    std::vector<float> m_projected; // scratch [3 * vertexCount]: pixel x, pixel y, depth
};

} // namespace penumbra
