// Occlusion along all lines of one direction, from one orthographic rasterisation (findings section
// 3).
//
// Lines parallel to w fall on a square grid over the bounding sphere's disc. Each keeps the
// interval [near, far] of the mesh's depths p.w. A ray from p along +w is blocked if far > p.w,
// along -w if near < p.w: a point between two surfaces sees neither direction.
#pragma once

#include "shaders/shared/interop.h"

#include <cstdint>
#include <span>
#include <vector>

namespace penumbra {

// Points in struct-of-arrays form, unit: bounding radii, relative to the sphere's centre.
struct PointSet {
    std::vector<float> x, y, z;
    [[nodiscard]] std::size_t size() const { return x.size(); }
};

// Triangles in struct-of-arrays form: corner[k][t] is the vertex at corner k of triangle t.
struct TriangleSet {
    std::vector<std::uint32_t> corner[3];
    explicit TriangleSet(std::span<const std::uint32_t> indices);
};

// Working memory of rasterise, to be kept by a thread.
struct RasterScratch {
    std::vector<float> near, far; // hold nothing between rasters
    std::vector<float> x, y, z;   // [vertexCount] projected: pixels, pixels, depth
};

class LineSpace {
public:
    // `side`: lines across the bounding sphere.
    explicit LineSpace(std::uint32_t side);

    // Rasterises the triangles (vertices inside the unit sphere) along unit direction w.
    void rasterise(vec3 w, const PointSet& vertices, const TriangleSet& triangles,
                   RasterScratch& scratch);

    // blocked[0][i]: the part, 0 to 1 (a little more where a cell rounds to more lines than it
    // covers), of the rays around +w from point begin + i that is blocked,
    // blocked[1][i] that around -w. Returns bit 0 if some ray around w is blocked, bit 1 if some
    // around -w. At most kMaxLookUp points.
    //
    // cellHalfWidth 0: the ray along w alone. Otherwise all rays of the direction's cell, a square
    // of that half width (radians), for points well outside the bounding sphere: the ray along
    // w + d has left the line along w by t d at distance t, and meets the object near distance
    // |p.w|, so the part is that of a square of lines of half width |p.w| cellHalfWidth which hit
    // anything.
    static constexpr std::size_t kMaxLookUp = 256;
    using BlockedParts = float[2][kMaxLookUp];
    unsigned lookUp(const PointSet& points, std::size_t begin, std::size_t count,
                    float cellHalfWidth, BlockedParts& blocked) const;

private:
    std::uint32_t m_side; // pixels, a multiple of 8
    vec3 m_u{0}, m_v{0}, m_w{0};
    std::vector<std::uint32_t> m_lines; // [(side + 2)^2 + padding] an empty pixel all around; far
                                        // depth in the high half, near in the low, 0: hits nothing
    std::vector<std::uint32_t> m_sums;  // [(side + 2)^2 + padding] lines before each that hit
};

} // namespace penumbra
