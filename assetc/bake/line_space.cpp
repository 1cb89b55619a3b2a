#include "assetc/bake/line_space.h"

#include "runtime/assert.h"

#include <algorithm>
#include <cstring>
#include <limits>

// One copy per instruction set, chosen when the program starts; -ffp-contract=off keeps their bits
// equal.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) &&                             \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define PENUMBRA_CLONES                                                                            \
    __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define PENUMBRA_CLONES
#endif

namespace penumbra {

namespace {

constexpr int kLanes = 8;
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));
constexpr float kNothing = std::numeric_limits<float>::max();
constexpr float kDepthStep = 2.0f / 65535; // of a stored depth; a pixel of 512 is 128 times that
constexpr float kBeyond = 1e9f;            // taken off the depth of a line that hits nothing

// The raster has an empty pixel all around, which lines beside it are moved to.
constexpr int pitchOf(int side)
{
    return side + 2;
}

struct Triangle {
    float x[3], y[3], z[3]; // pixels, pixels, depth
};

// Widens near/far of every pixel whose centre the triangle covers. 8 pixels of a row at a time.
inline __attribute__((always_inline)) void drawTriangle(const Triangle& t, int side, float* near,
                                                        float* far)
{
    const float area =
        (t.x[1] - t.x[0]) * (t.y[2] - t.y[0]) - (t.x[2] - t.x[0]) * (t.y[1] - t.y[0]);
    const float minX = std::min({t.x[0], t.x[1], t.x[2]}),
                maxX = std::max({t.x[0], t.x[1], t.x[2]});
    const float minY = std::min({t.y[0], t.y[1], t.y[2]}),
                maxY = std::max({t.y[0], t.y[1], t.y[2]});
    const int x0 = std::max(0, static_cast<int>(std::ceil(minX))),
              x1 = std::min(side - 1, static_cast<int>(maxX));
    const int y0 = std::max(0, static_cast<int>(std::ceil(minY))),
              y1 = std::min(side - 1, static_cast<int>(maxY));
    if (x0 > x1 || y0 > y1 || std::abs(area) < 1e-12f)
        return;

    // Barycentric coordinate a_k grows by dx_k per pixel in x and dy_k in y; depth is linear as
    // well.
    const float invArea = 1 / area;
    float corner[3], dx[3], dy[3], depthCorner = 0, depthDx = 0, depthDy = 0;
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        dx[k] = (t.y[i] - t.y[j]) * invArea;
        dy[k] = (t.x[j] - t.x[i]) * invArea;
        corner[k] =
            dx[k] * (static_cast<float>(x0) - t.x[i]) + dy[k] * (static_cast<float>(y0) - t.y[i]);
        depthCorner += corner[k] * t.z[k];
        depthDx += dx[k] * t.z[k];
        depthDy += dy[k] * t.z[k];
    }
    const Lanes lane = {0, 1, 2, 3, 4, 5, 6, 7};
    for (int y = y0; y <= y1; ++y) {
        const auto down = static_cast<float>(y - y0);
        const float row[3] = {corner[0] + down * dy[0], corner[1] + down * dy[1],
                              corner[2] + down * dy[2]};
        const float depthRow = depthCorner + down * depthDy;
        for (int x = x0; x <= x1; x += kLanes) {
            const Lanes step = lane + static_cast<float>(x - x0);
            // Only lanes up to x1 count. Coverage is inclusive on all edges: a line on an edge hits
            // both triangles, but for the rounding of these few operations.
            const auto covered = (row[0] + step * dx[0] >= 0.0f) & (row[1] + step * dx[1] >= 0.0f) &
                                 (row[2] + step * dx[2] >= 0.0f) &
                                 (step <= static_cast<float>(x1 - x0));
            const Lanes depth = depthRow + step * depthDx;
            const auto pixel = static_cast<std::size_t>((y + 1) * pitchOf(side) + x + 1);
            Lanes nearest, farthest;
            std::memcpy(&nearest, near + pixel, sizeof(Lanes));
            std::memcpy(&farthest, far + pixel, sizeof(Lanes));
            nearest = (covered & (depth < nearest)) ? depth : nearest;
            farthest = (covered & (depth > farthest)) ? depth : farthest;
            std::memcpy(near + pixel, &nearest, sizeof(Lanes));
            std::memcpy(far + pixel, &farthest, sizeof(Lanes));
        }
    }
}

PENUMBRA_CLONES void drawTriangles(const float* projected, const std::uint32_t* indices,
                                   std::size_t indexCount, int side, float* near, float* far)
{
    for (std::size_t i = 0; i < indexCount; i += 3) {
        Triangle t;
        for (int k = 0; k < 3; ++k) {
            const float* vertex =
                projected + 3 * static_cast<std::size_t>(indices[i + static_cast<std::size_t>(k)]);
            t.x[k] = vertex[0];
            t.y[k] = vertex[1];
            t.z[k] = vertex[2];
        }
        drawTriangle(t, side, near, far);
    }
}

struct LookUp {
    vec3 u, v, w;
    float side;
    const std::uint32_t* lines;
    const float *x, *y, *z; // points
};

// Where a line meets the raster, in pixels from its lower corner, and a point's depth on it.
struct Lines {
    float column[LineSpace::kMaxLookUp], row[LineSpace::kMaxLookUp], depth[LineSpace::kMaxLookUp];
};

// Everything below compiles to vector code without branches.
inline __attribute__((always_inline)) void project(const LookUp& l, std::size_t count, Lines& lines)
{
    const float half = 0.5f * l.side;
    for (std::size_t i = 0; i < count; ++i) {
        const float x = l.x[i], y = l.y[i], z = l.z[i];
        lines.column[i] = (x * l.u.x + y * l.u.y + z * l.u.z) * half + half;
        lines.row[i] = (x * l.v.x + y * l.v.y + z * l.v.z) * half + half;
        lines.depth[i] = x * l.w.x + y * l.w.y + z * l.w.z;
    }
}

// What the four lines around a point's line hit: depth along w and along -w, 1 where anything.
struct Corners {
    float far[4][LineSpace::kMaxLookUp], near[4][LineSpace::kMaxLookUp];
    float hit[4][LineSpace::kMaxLookUp];
};

inline __attribute__((always_inline)) void readCorner(const std::uint32_t* raster, const int* pixel,
                                                      std::size_t count, float* far, float* near,
                                                      float* hit)
{
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t line = raster[pixel[i]];
        const auto packedFar = static_cast<float>(static_cast<int>(line >> 16));
        const auto packedNear = static_cast<float>(static_cast<int>(line & 0xffff));
        hit[i] = std::min(packedFar, 1.0f);
        const float nothing = 1 + (1 - hit[i]) * kBeyond;
        far[i] = packedFar * kDepthStep - nothing;
        near[i] = packedNear * kDepthStep - nothing;
    }
}

// Depths are interpolated between the four nearest lines where all of them hit something, so that a
// point beside a slanted surface meets it where it is; at a rim the nearest line decides. In loops
// that compilers vectorise one by one.
PENUMBRA_CLONES int lookUpLines(const LookUp& l, std::size_t count, float* plus, float* minus)
{
    Lines lines;
    project(l, count, lines);
    int pixel[LineSpace::kMaxLookUp];
    float u[LineSpace::kMaxLookUp], v[LineSpace::kMaxLookUp];
    const int pitch = pitchOf(static_cast<int>(l.side));
    for (std::size_t i = 0; i < count; ++i) {
        // From 0.5: the centre of pixel 0 of the raster with its rim lies there.
        // Up to nearer to the rim than to the last pixel.
        const float x = std::min(std::max(lines.column[i] + 0.5f, 0.0f), l.side + 0.75f);
        const float y = std::min(std::max(lines.row[i] + 0.5f, 0.0f), l.side + 0.75f);
        pixel[i] = static_cast<int>(y) * pitch + static_cast<int>(x);
        u[i] = x - static_cast<float>(static_cast<int>(x));
        v[i] = y - static_cast<float>(static_cast<int>(y));
    }
    Corners corners;
    for (int k = 0; k < 4; ++k)
        readCorner(l.lines + (k & 1) + (k >> 1) * pitch, pixel, count, corners.far[k],
                   corners.near[k], corners.hit[k]);
    for (std::size_t i = 0; i < count; ++i) {
        const float hits =
            corners.hit[0][i] * corners.hit[1][i] * corners.hit[2][i] * corners.hit[3][i];
        const auto nearestU = static_cast<float>(static_cast<int>(u[i] + 0.5f));
        const auto nearestV = static_cast<float>(static_cast<int>(v[i] + 0.5f));
        const float wu = nearestU + hits * (u[i] - nearestU);
        const float wv = nearestV + hits * (v[i] - nearestV);
        const auto blend = [&](const float(&at)[4][LineSpace::kMaxLookUp]) {
            return (at[0][i] * (1 - wu) + at[1][i] * wu) * (1 - wv) +
                   (at[2][i] * (1 - wu) + at[3][i] * wu) * wv;
        };
        plus[i] = blend(corners.far) > lines.depth[i] ? 1.0f : 0.0f;
        minus[i] = blend(corners.near) > -lines.depth[i] ? 1.0f : 0.0f;
    }
    int any = 0;
    for (std::size_t i = 0; i < count; ++i)
        any |= plus[i] + minus[i] > 0 ? 1 : 0;
    return any;
}

PENUMBRA_CLONES int lookUpBoxes(const LookUp& l, const std::uint32_t* sums, std::size_t count,
                                float cellHalfWidth, float* plus, float* minus)
{
    Lines lines;
    project(l, count, lines);
    const float side = l.side;
    const int pitch = pitchOf(static_cast<int>(side));
    int any = 0;
    for (std::size_t i = 0; i < count; ++i) {
        // At least a pixel.
        const float half = std::max(cellHalfWidth * std::abs(lines.depth[i]) * 0.5f * side, 0.5f);
        // Sums end before pixel x, y; from 1, which holds nothing, to side + 1, which holds all.
        const auto edge = [&](float at) {
            return static_cast<int>(std::min(std::max(at + 1.5f, 1.0f), side + 1.0f));
        };
        const int x0 = edge(lines.column[i] - half), x1 = edge(lines.column[i] + half);
        const int y0 = edge(lines.row[i] - half) * pitch, y1 = edge(lines.row[i] + half) * pitch;
        const auto hits = static_cast<float>(
            static_cast<int>(sums[y1 + x1] - sums[y1 + x0] - sums[y0 + x1] + sums[y0 + x0]));
        const float part = hits / (4 * half * half);
        plus[i] = lines.depth[i] < 0 ? part : 0.0f;
        minus[i] = lines.depth[i] < 0 ? 0.0f : part;
        any |= part > 0 ? 1 : 0;
    }
    return any;
}

// sums[y][x]: lines that hit something in rows below y and columns below x.
void sumHits(const std::uint32_t* lines, int side, std::uint32_t* sums)
{
    const auto pitch = static_cast<std::size_t>(pitchOf(side));
    std::fill(sums, sums + pitch, 0u);
    for (std::size_t y = 1; y < pitch; ++y) {
        std::uint32_t row = 0;
        sums[y * pitch] = 0;
        for (std::size_t x = 1; x < pitch; ++x) {
            row += lines[(y - 1) * pitch + x - 1] != 0 ? 1 : 0;
            sums[y * pitch + x] = sums[(y - 1) * pitch + x] + row;
        }
    }
}

// Depths in 1 to 65535, -1 to 1; the nearest with its sign turned, so that 0 means none for both.
PENUMBRA_CLONES void packDepths(const float* near, const float* far, std::size_t count,
                                std::uint32_t* lines)
{
    for (std::size_t i = 0; i < count; ++i) {
        const float f = std::min(std::max((far[i] + 1.0f) / kDepthStep + 0.5f, 1.0f), 65535.0f);
        const float n = std::min(std::max((1.0f - near[i]) / kDepthStep + 0.5f, 1.0f), 65535.0f);
        const auto packed = static_cast<std::uint32_t>(static_cast<int>(f)) << 16 |
                            static_cast<std::uint32_t>(static_cast<int>(n));
        lines[i] = far[i] < near[i] ? 0u : packed;
    }
}

} // namespace

LineSpace::LineSpace(std::uint32_t side) : m_side(side)
{
    PENUMBRA_ASSERT(side % kLanes == 0 && side > 0 && side <= 4096,
                    "raster side {} must be a multiple of 8, at most 4096", side);
    // The last row's vector may reach over its end, into the line that hits nothing but never
    // covering it.
    const auto pitch = static_cast<std::size_t>(pitchOf(static_cast<int>(side)));
    const std::size_t pixels = pitch * pitch + kLanes;
    m_lines.resize(pixels);
    m_sums.resize(pixels);
}

void LineSpace::rasterise(vec3 w, const PointSet& vertices,
                          const std::vector<std::uint32_t>& indices, RasterScratch& scratch)
{
    // Any frame will do; start from the axis that is least parallel to w.
    const vec3 a = glm::abs(w);
    const vec3 axis = a.x <= a.y && a.x <= a.z ? vec3(1, 0, 0)
                      : a.y <= a.z             ? vec3(0, 1, 0)
                                               : vec3(0, 0, 1);
    m_w = w;
    m_u = normalize(cross(axis, w));
    m_v = cross(w, m_u);

    scratch.near.assign(m_lines.size(), kNothing);
    scratch.far.assign(m_lines.size(), -kNothing);
    const float half = 0.5f * static_cast<float>(m_side);
    scratch.projected.resize(3 * vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const vec3 p(vertices.x[i], vertices.y[i], vertices.z[i]);
        scratch.projected[3 * i] =
            dot(p, m_u) * half + half - 0.5f; // pixel centres at whole numbers
        scratch.projected[3 * i + 1] = dot(p, m_v) * half + half - 0.5f;
        scratch.projected[3 * i + 2] = dot(p, m_w);
    }
    drawTriangles(scratch.projected.data(), indices.data(), indices.size(),
                  static_cast<int>(m_side), scratch.near.data(), scratch.far.data());
    packDepths(scratch.near.data(), scratch.far.data(), m_lines.size(), m_lines.data());
    sumHits(m_lines.data(), static_cast<int>(m_side), m_sums.data());
}

bool LineSpace::lookUp(const PointSet& points, std::size_t begin, std::size_t count,
                       float cellHalfWidth, BlockedParts& blocked) const
{
    PENUMBRA_ASSERT(count <= kMaxLookUp, "{} points at once", count);
    const LookUp l{m_u,
                   m_v,
                   m_w,
                   static_cast<float>(m_side),
                   m_lines.data(),
                   points.x.data() + begin,
                   points.y.data() + begin,
                   points.z.data() + begin};
    const int any = cellHalfWidth == 0 ? lookUpLines(l, count, blocked[0], blocked[1])
                                       : lookUpBoxes(l, m_sums.data(), count, cellHalfWidth,
                                                     blocked[0], blocked[1]);
    return any != 0;
}

} // namespace penumbra
