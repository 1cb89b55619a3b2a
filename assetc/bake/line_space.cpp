#include "assetc/bake/line_space.h"

#include "assetc/bake/target_clones.h"
#include "runtime/assert.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

namespace penumbra {

namespace {

constexpr int kLanes = 8;
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));
using Ints = int __attribute__((vector_size(kLanes * sizeof(int))));
constexpr float kNothing = std::numeric_limits<float>::max();
constexpr float kDepthStep = 2.0f / 65535; // of a stored depth; a pixel of 512 is 128 times that
constexpr float kBeyond = 1e9f;            // taken off the depth of a line that hits nothing

// The raster has an empty pixel all around, which lines beside it are moved to.
constexpr int pitchOf(int side)
{
    return side + 2;
}

// Corners in pixels, pixel centres at whole numbers, and depth: [vertex].
struct Projected {
    const float *x, *y, *z;
};

// Triangles made ready to draw, in loops that compilers vectorise.
constexpr std::size_t kSetUp = 64;
constexpr int kClasses = 8;
struct SetUp {
    int pixel[kSetUp]; // the lower corner
    int columns[kSetUp], rows[kSetUp];
    int rowClass[kSetUp]; // see Classes
    // Barycentric coordinate k is corner[k] at the lower corner, grows by dx[k] per pixel in x and
    // dy[k] in y; depth likewise.
    float corner[3][kSetUp], dx[3][kSetUp], dy[3][kSetUp];
    float depth[kSetUp], depthDx[kSetUp], depthDy[kSetUp];
};

PENUMBRA_INLINE int ceilToPixel(float at) // of coordinates above -1
{
    const int whole = static_cast<int>(at);
    return whole + (at > static_cast<float>(whole) ? 1 : 0);
}

PENUMBRA_INLINE void setUpTriangles(const Projected& p, const std::uint32_t* const corners[3],
                                    std::size_t count, int side, SetUp& out)
{
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t a = corners[0][i], b = corners[1][i], c = corners[2][i];
        const float xa = p.x[a], xb = p.x[b], xc = p.x[c];
        const float ya = p.y[a], yb = p.y[b], yc = p.y[c];
        const float za = p.z[a], zb = p.z[b], zc = p.z[c];
        const float area = (xb - xa) * (yc - ya) - (xc - xa) * (yb - ya);
        const int x0 = std::max(0, ceilToPixel(std::min(std::min(xa, xb), xc)));
        const int y0 = std::max(0, ceilToPixel(std::min(std::min(ya, yb), yc)));
        const int x1 = std::min(side - 1, static_cast<int>(std::max(std::max(xa, xb), xc)));
        const int y1 = std::min(side - 1, static_cast<int>(std::max(std::max(ya, yb), yc)));
        const bool empty = (x0 > x1) | (y0 > y1) | (std::abs(area) < 1e-12f);
        out.pixel[i] = (y0 + 1) * pitchOf(side) + x0 + 1;
        const int columns = x1 - x0 + 1, rows = y1 - y0 + 1;
        out.columns[i] = columns;
        out.rows[i] = rows;
        out.rowClass[i] = empty              ? 0
                          : columns > kLanes ? kClasses - 1
                                             : std::min(rows, kClasses - 1);
        const float invArea = 1 / area;
        const auto x = static_cast<float>(x0), y = static_cast<float>(y0);
        const float dxa = (yb - yc) * invArea, dya = (xc - xb) * invArea;
        const float dxb = (yc - ya) * invArea, dyb = (xa - xc) * invArea;
        const float dxc = (ya - yb) * invArea, dyc = (xb - xa) * invArea;
        const float cornerA = dxa * (x - xb) + dya * (y - yb);
        const float cornerB = dxb * (x - xc) + dyb * (y - yc);
        const float cornerC = dxc * (x - xa) + dyc * (y - ya);
        out.corner[0][i] = cornerA;
        out.corner[1][i] = cornerB;
        out.corner[2][i] = cornerC;
        out.dx[0][i] = dxa;
        out.dx[1][i] = dxb;
        out.dx[2][i] = dxc;
        out.dy[0][i] = dya;
        out.dy[1][i] = dyb;
        out.dy[2][i] = dyc;
        out.depth[i] = cornerA * za + cornerB * zb + cornerC * zc;
        out.depthDx[i] = dxa * za + dxb * zb + dxc * zc;
        out.depthDy[i] = dya * za + dyb * zb + dyc * zc;
    }
}

// Depths while triangles are drawn: the nearest and the farthest so far.
struct Depths {
    float *near, *far; // [pitch * pitch + padding]
    int pitch;
};

// Rows that edge functions are added up over before they are worked out anew: each sum rounds.
constexpr int kRowsAtOnce = 8;

// Widens near/far of every pixel whose centre triangle i covers, in at most 8 columns from `x` on
// and `rows` rows, at most kRowsAtOnce, from `y` on.
PENUMBRA_INLINE void drawPart(const SetUp& t, std::size_t i, int x, int y, int rows,
                              const Depths& depths)
{
    const Lanes lane = {0, 1, 2, 3, 4, 5, 6, 7};
    const Lanes step = lane + static_cast<float>(x);
    const auto down = static_cast<float>(y);
    const auto inside = step < static_cast<float>(t.columns[i]);
    Lanes a = t.corner[0][i] + down * t.dy[0][i] + step * t.dx[0][i];
    Lanes b = t.corner[1][i] + down * t.dy[1][i] + step * t.dx[1][i];
    Lanes c = t.corner[2][i] + down * t.dy[2][i] + step * t.dx[2][i];
    Lanes depth = t.depth[i] + down * t.depthDy[i] + step * t.depthDx[i];
    const int pitch = depths.pitch;
    float* near = depths.near + t.pixel[i] + x + y * pitch;
    float* far = depths.far + t.pixel[i] + x + y * pitch;
    for (int row = 0; row < rows; ++row, near += pitch, far += pitch) {
        // Coverage is inclusive on all edges: a line on an edge hits both triangles, but for the
        // rounding of these few operations.
        const auto covered = (a >= 0.0f) & (b >= 0.0f) & (c >= 0.0f) & inside;
        Lanes nearest, farthest;
        std::memcpy(&nearest, near, sizeof(Lanes));
        std::memcpy(&farthest, far, sizeof(Lanes));
        nearest = (covered & (depth < nearest)) ? depth : nearest;
        farthest = (covered & (depth > farthest)) ? depth : farthest;
        std::memcpy(near, &nearest, sizeof(Lanes));
        std::memcpy(far, &farthest, sizeof(Lanes));
        a += t.dy[0][i];
        b += t.dy[1][i];
        c += t.dy[2][i];
        depth += t.depthDy[i];
    }
}

// A class of triangles for each count of rows, so that loops over rows end where they are expected
// to. Class 0 covers no pixel; the last is for all that are higher than it or wider than a vector.
struct Classes {
    std::uint8_t members[kClasses][kSetUp];
    std::size_t count[kClasses] = {};
};

template <int kRows>
PENUMBRA_INLINE void drawClasses(const SetUp& t, const Classes& classes, const Depths& depths)
{
    for (std::size_t k = 0; k < classes.count[kRows]; ++k)
        drawPart(t, classes.members[kRows][k], 0, 0, kRows, depths);
    if constexpr (kRows + 2 < kClasses)
        drawClasses<kRows + 1>(t, classes, depths);
}

PENUMBRA_CLONES void drawTriangles(const Projected& projected,
                                   const std::uint32_t* const corners[3], std::size_t count,
                                   int side, const Depths& depths)
{
    SetUp ready;
    for (std::size_t first = 0; first < count; first += kSetUp) {
        const std::size_t n = std::min(kSetUp, count - first);
        const std::uint32_t* const from[3] = {corners[0] + first, corners[1] + first,
                                              corners[2] + first};
        setUpTriangles(projected, from, n, side, ready);
        Classes classes;
        for (std::size_t i = 0; i < n; ++i)
            classes.members[ready.rowClass[i]][classes.count[ready.rowClass[i]]++] =
                static_cast<std::uint8_t>(i);
        drawClasses<1>(ready, classes, depths);
        for (std::size_t k = 0; k < classes.count[kClasses - 1]; ++k) {
            const std::size_t i = classes.members[kClasses - 1][k];
            for (int y = 0; y < ready.rows[i]; y += kRowsAtOnce)
                for (int x = 0; x < ready.columns[i]; x += kLanes)
                    drawPart(ready, i, x, y, std::min(kRowsAtOnce, ready.rows[i] - y), depths);
        }
    }
}

struct Frame { // right-handed; w along the lines
    vec3 u, v, w;
};

struct LookUp {
    Frame frame;
    float side;
    const std::uint32_t* packed; // depths of all lines
    const float *x, *y, *z;      // points
};

// Where a line meets the raster, in pixels from its lower corner, and a point's depth on it.
struct Lines {
    float column[LineSpace::kMaxLookUp], row[LineSpace::kMaxLookUp], depth[LineSpace::kMaxLookUp];
};

// Everything below compiles to vector code without branches.
PENUMBRA_INLINE void project(const LookUp& l, std::size_t count, Lines& lines)
{
    const float half = 0.5f * l.side;
    for (std::size_t i = 0; i < count; ++i) {
        const float x = l.x[i], y = l.y[i], z = l.z[i];
        lines.column[i] = (x * l.frame.u.x + y * l.frame.u.y + z * l.frame.u.z) * half + half;
        lines.row[i] = (x * l.frame.v.x + y * l.frame.v.y + z * l.frame.v.z) * half + half;
        lines.depth[i] = x * l.frame.w.x + y * l.frame.w.y + z * l.frame.w.z;
    }
}

// What the four lines around a point's line hit: depth along w and along -w, 1 where anything.
struct Corners {
    float far[4][LineSpace::kMaxLookUp], near[4][LineSpace::kMaxLookUp];
    float hit[4][LineSpace::kMaxLookUp];
};

PENUMBRA_INLINE void readCorner(const std::uint32_t* raster, const int* pixel, std::size_t count,
                                float* far, float* near, float* hit)
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

// Points whose nearest line hits something this close to them in depth, in pixels, ask the lines
// around it as well. Surfaces steeper than 1 in 16 against the lines are missed, and depend on
// noise.
constexpr float kNearBand = 8;

// The nearest line decides for all points; `close` lists those it does not settle, [count] at most.
PENUMBRA_CLONES std::size_t lookUpNearest(const LookUp& l, const Lines& lines, std::size_t count,
                                          float* __restrict plus, float* __restrict minus,
                                          std::uint8_t* close)
{
    const int pitch = pitchOf(static_cast<int>(l.side));
    const float band = kNearBand * 2 / l.side;
    int pixel[LineSpace::kMaxLookUp], unsettled[LineSpace::kMaxLookUp];
    for (std::size_t i = 0; i < count; ++i) {
        // Pixel 0 of the raster with its rim covers -1 to 0.
        const float x = std::min(std::max(lines.column[i] + 1, 0.0f), l.side + 1);
        const float y = std::min(std::max(lines.row[i] + 1, 0.0f), l.side + 1);
        pixel[i] = static_cast<int>(y) * pitch + static_cast<int>(x);
    }
    const std::uint32_t* const raster = l.packed;
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t line = raster[pixel[i]];
        const auto packedFar = static_cast<float>(static_cast<int>(line >> 16));
        const auto packedNear = static_cast<float>(static_cast<int>(line & 0xffff));
        const float nothing = 1 + (1 - std::min(packedFar, 1.0f)) * kBeyond;
        const float beyondFar = packedFar * kDepthStep - nothing - lines.depth[i];
        const float beforeNear = packedNear * kDepthStep - nothing + lines.depth[i];
        plus[i] = beyondFar > 0 ? 1.0f : 0.0f;
        minus[i] = beforeNear > 0 ? 1.0f : 0.0f;
        unsettled[i] = std::min(std::abs(beyondFar), std::abs(beforeNear)) < band ? 1 : 0;
    }
    std::size_t found = 0;
    for (std::size_t i = 0; i < count; ++i) {
        close[found] = static_cast<std::uint8_t>(i);
        found += static_cast<std::size_t>(unsettled[i]);
    }
    return found;
}

// Depths are interpolated between the four nearest lines where all of them hit something, so that a
// point beside a slanted surface meets it where it is; at a rim the nearest line decides. In loops
// that compilers vectorise one by one.
PENUMBRA_CLONES void lookUpBetween(const LookUp& l, const Lines& lines, const std::uint8_t* close,
                                   std::size_t count, float* plus, float* minus)
{
    int pixel[LineSpace::kMaxLookUp];
    float u[LineSpace::kMaxLookUp], v[LineSpace::kMaxLookUp];
    const int pitch = pitchOf(static_cast<int>(l.side));
    for (std::size_t k = 0; k < count; ++k) {
        // From 0.5: the centre of pixel 0 of the raster with its rim lies there.
        // Up to nearer to the rim than to the last pixel.
        const float x = std::min(std::max(lines.column[close[k]] + 0.5f, 0.0f), l.side + 0.75f);
        const float y = std::min(std::max(lines.row[close[k]] + 0.5f, 0.0f), l.side + 0.75f);
        pixel[k] = static_cast<int>(y) * pitch + static_cast<int>(x);
        u[k] = x - static_cast<float>(static_cast<int>(x));
        v[k] = y - static_cast<float>(static_cast<int>(y));
    }
    Corners corners;
    for (int k = 0; k < 4; ++k)
        readCorner(l.packed + (k & 1) + (k >> 1) * pitch, pixel, count, corners.far[k],
                   corners.near[k], corners.hit[k]);
    float far[LineSpace::kMaxLookUp], near[LineSpace::kMaxLookUp];
    for (std::size_t k = 0; k < count; ++k) {
        const float hits =
            corners.hit[0][k] * corners.hit[1][k] * corners.hit[2][k] * corners.hit[3][k];
        const auto nearestU = static_cast<float>(static_cast<int>(u[k] + 0.5f));
        const auto nearestV = static_cast<float>(static_cast<int>(v[k] + 0.5f));
        const float wu = nearestU + hits * (u[k] - nearestU);
        const float wv = nearestV + hits * (v[k] - nearestV);
        far[k] = (corners.far[0][k] * (1 - wu) + corners.far[1][k] * wu) * (1 - wv) +
                 (corners.far[2][k] * (1 - wu) + corners.far[3][k] * wu) * wv;
        near[k] = (corners.near[0][k] * (1 - wu) + corners.near[1][k] * wu) * (1 - wv) +
                  (corners.near[2][k] * (1 - wu) + corners.near[3][k] * wu) * wv;
    }
    for (std::size_t k = 0; k < count; ++k) {
        plus[close[k]] = far[k] > lines.depth[close[k]] ? 1.0f : 0.0f;
        minus[close[k]] = near[k] > -lines.depth[close[k]] ? 1.0f : 0.0f;
    }
}

// Bit 0: some plus above 0, bit 1: some minus.
PENUMBRA_CLONES unsigned anyOf(const float* plus, const float* minus, std::size_t count)
{
    unsigned any = 0;
    for (std::size_t i = 0; i < count; ++i)
        any |= (plus[i] > 0 ? 1u : 0u) | (minus[i] > 0 ? 2u : 0u);
    return any;
}

PENUMBRA_CLONES void projectPoints(const LookUp& l, std::size_t count, Lines& lines)
{
    project(l, count, lines);
}

void lookUpLines(const LookUp& l, std::size_t count, float* plus, float* minus)
{
    Lines lines;
    projectPoints(l, count, lines);
    std::uint8_t close[LineSpace::kMaxLookUp];
    const std::size_t unsettled = lookUpNearest(l, lines, count, plus, minus, close);
    if (unsettled > 0)
        lookUpBetween(l, lines, close, unsettled, plus, minus);
}

PENUMBRA_CLONES void lookUpBoxes(const LookUp& l, const std::uint32_t* sums, std::size_t count,
                                 float cellHalfWidth, float* plus, float* minus)
{
    Lines lines;
    project(l, count, lines);
    const float side = l.side;
    const int pitch = pitchOf(static_cast<int>(side));
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
    }
}

// Depths to lines: 1 to 65535 for -1 to 1; the nearest with its sign turned, so that 0 means none
// for both. sums[y][x]: lines that hit something in rows below y and columns below x. near and far
// hold nothing again afterwards.
PENUMBRA_CLONES void finishRaster(const Depths& depths, int side, std::uint32_t* lines,
                                  std::uint32_t* sums)
{
    float *near = depths.near, *far = depths.far;
    const Lanes one = Lanes{} + 1.0f, largest = Lanes{} + 65535.0f;
    const int pitch = depths.pitch;
    for (int y = 0; y < side; ++y) {
        Ints before = {};
        for (int x = 0; x < side; x += kLanes) {
            const int at = (y + 1) * pitch + x + 1;
            Lanes nearest, farthest;
            std::memcpy(&nearest, near + at, sizeof(Lanes));
            std::memcpy(&farthest, far + at, sizeof(Lanes));
            const Ints hit = farthest >= nearest;
            Ints halves[2];
            for (const int k : {0, 1}) {
                Lanes steps = ((k == 0 ? farthest : -nearest) + 1.0f) * (1 / kDepthStep) + 0.5f;
                steps = steps < one ? one : steps;
                halves[k] = __builtin_convertvector(steps < largest ? steps : largest, Ints);
            }
            const Ints packed = (halves[0] << 16 | halves[1]) & hit;
            std::memcpy(lines + at, &packed, sizeof(Ints));

            Ints sum = -hit; // then the running sum of it
            sum += __builtin_shufflevector(sum, Ints{}, 8, 0, 1, 2, 3, 4, 5, 6);
            sum += __builtin_shufflevector(sum, Ints{}, 8, 8, 0, 1, 2, 3, 4, 5);
            sum += __builtin_shufflevector(sum, Ints{}, 8, 8, 8, 8, 0, 1, 2, 3);
            sum += before;
            before = Ints{} + sum[kLanes - 1];
            Ints below;
            std::memcpy(&below, sums + at + 1, sizeof(Ints));
            sum += below;
            std::memcpy(sums + at + 1 + pitch, &sum, sizeof(Ints));

            nearest = Lanes{} + kNothing;
            farthest = Lanes{} - kNothing;
            std::memcpy(near + at, &nearest, sizeof(Lanes));
            std::memcpy(far + at, &farthest, sizeof(Lanes));
        }
    }
}

PENUMBRA_CLONES void projectVertices(const PointSet& vertices, const Frame& f, float side,
                                     RasterScratch& out)
{
    const float half = 0.5f * side, centre = half - 0.5f; // pixel centres at whole numbers
    const float *px = vertices.x.data(), *py = vertices.y.data(), *pz = vertices.z.data();
    float *outX = out.x.data(), *outY = out.y.data(), *outZ = out.z.data();
    const std::size_t count = vertices.x.size();
    for (std::size_t i = 0; i < count; ++i) {
        outX[i] = (px[i] * f.u.x + py[i] * f.u.y + pz[i] * f.u.z) * half + centre;
        outY[i] = (px[i] * f.v.x + py[i] * f.v.y + pz[i] * f.v.z) * half + centre;
        outZ[i] = px[i] * f.w.x + py[i] * f.w.y + pz[i] * f.w.z;
    }
}

} // namespace

TriangleSet::TriangleSet(std::span<const std::uint32_t> indices)
{
    for (std::size_t i = 0; i < indices.size(); ++i)
        corner[i % 3].push_back(indices[i]);
}

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

void LineSpace::rasterise(vec3 w, const PointSet& vertices, const TriangleSet& triangles,
                          RasterScratch& scratch)
{
    // Any frame will do; start from the axis that is least parallel to w.
    const vec3 a = glm::abs(w);
    const vec3 axis = a.x <= a.y && a.x <= a.z ? vec3(1, 0, 0)
                      : a.y <= a.z             ? vec3(0, 1, 0)
                                               : vec3(0, 0, 1);
    m_w = w;
    m_u = normalize(cross(axis, w));
    m_v = cross(w, m_u);

    if (scratch.near.size() != m_lines.size()) {
        scratch.near.assign(m_lines.size(), kNothing);
        scratch.far.assign(m_lines.size(), -kNothing);
    }
    for (std::vector<float>* projected : {&scratch.x, &scratch.y, &scratch.z})
        projected->resize(vertices.size());
    projectVertices(vertices, {m_u, m_v, m_w}, static_cast<float>(m_side), scratch);
    const std::uint32_t* const corners[3] = {triangles.corner[0].data(), triangles.corner[1].data(),
                                             triangles.corner[2].data()};
    const auto side = static_cast<int>(m_side);
    const Depths depths{scratch.near.data(), scratch.far.data(), pitchOf(side)};
    drawTriangles({scratch.x.data(), scratch.y.data(), scratch.z.data()}, corners,
                  triangles.corner[0].size(), side, depths);
    finishRaster(depths, side, m_lines.data(), m_sums.data());
}

unsigned LineSpace::lookUp(const PointSet& points, std::size_t begin, std::size_t count,
                           float cellHalfWidth, BlockedParts& blocked) const
{
    PENUMBRA_ASSERT(count <= kMaxLookUp, "{} points at once", count);
    const LookUp l{{m_u, m_v, m_w},         static_cast<float>(m_side), m_lines.data(),
                   points.x.data() + begin, points.y.data() + begin,    points.z.data() + begin};
    if (cellHalfWidth == 0)
        lookUpLines(l, count, blocked[0], blocked[1]);
    else
        lookUpBoxes(l, m_sums.data(), count, cellHalfWidth, blocked[0], blocked[1]);
    return anyOf(blocked[0], blocked[1], count);
}

} // namespace penumbra
