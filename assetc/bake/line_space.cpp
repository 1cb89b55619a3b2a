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
            const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(side) +
                                      static_cast<std::size_t>(x);
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
    const float *near, *far;
    const float *x, *y, *z; // points
};

PENUMBRA_CLONES bool lookUpPoints(const LookUp& l, std::size_t count, std::uint8_t* blocked)
{
    const float half = 0.5f * l.side;
    const float nowhere =
        l.side * l.side; // the pixel that hits nothing; exact in a float for sides up to 4096
    int any = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const float x = l.x[i], y = l.y[i], z = l.z[i];
        const float column = std::floor((x * l.u.x + y * l.u.y + z * l.u.z) * half + half);
        const float line = std::floor((x * l.v.x + y * l.v.y + z * l.v.z) * half + half);
        const float depth = x * l.w.x + y * l.w.y + z * l.w.z;
        const bool inside = (column >= 0) & (column < l.side) & (line >= 0) & (line < l.side);
        const int pixel = static_cast<int>(inside ? line * l.side + column : nowhere);
        const int bits = (l.far[pixel] > depth ? 1 : 0) | (l.near[pixel] < depth ? 2 : 0);
        blocked[i] = static_cast<std::uint8_t>(bits);
        any |= bits;
    }
    return any != 0;
}

} // namespace

LineSpace::LineSpace(std::uint32_t side) : m_side(side)
{
    PENUMBRA_ASSERT(side % kLanes == 0 && side > 0 && side <= 4096,
                    "raster side {} must be a multiple of 8, at most 4096", side);
    // The last row's vector may reach over its end, into the line that hits nothing but never
    // covering it.
    const std::size_t pixels = static_cast<std::size_t>(side) * side + kLanes;
    m_near.resize(pixels);
    m_far.resize(pixels);
}

void LineSpace::rasterise(vec3 w, const PointSet& vertices,
                          const std::vector<std::uint32_t>& indices)
{
    // Any frame will do; start from the axis that is least parallel to w.
    const vec3 a = glm::abs(w);
    const vec3 axis = a.x <= a.y && a.x <= a.z ? vec3(1, 0, 0)
                      : a.y <= a.z             ? vec3(0, 1, 0)
                                               : vec3(0, 0, 1);
    m_w = w;
    m_u = normalize(cross(axis, w));
    m_v = cross(w, m_u);

    std::fill(m_near.begin(), m_near.end(), kNothing);
    std::fill(m_far.begin(), m_far.end(), -kNothing);
    const float half = 0.5f * static_cast<float>(m_side);
    m_projected.resize(3 * vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const vec3 p(vertices.x[i], vertices.y[i], vertices.z[i]);
        m_projected[3 * i] = dot(p, m_u) * half + half - 0.5f; // pixel centres at whole numbers
        m_projected[3 * i + 1] = dot(p, m_v) * half + half - 0.5f;
        m_projected[3 * i + 2] = dot(p, m_w);
    }
    drawTriangles(m_projected.data(), indices.data(), indices.size(), static_cast<int>(m_side),
                  m_near.data(), m_far.data());
}

bool LineSpace::lookUp(const PointSet& points, std::size_t begin, std::size_t count,
                       std::uint8_t* blocked) const
{
    const LookUp l{m_u,
                   m_v,
                   m_w,
                   static_cast<float>(m_side),
                   m_near.data(),
                   m_far.data(),
                   points.x.data() + begin,
                   points.y.data() + begin,
                   points.z.data() + begin};
    return lookUpPoints(l, count, blocked);
}

} // namespace penumbra
