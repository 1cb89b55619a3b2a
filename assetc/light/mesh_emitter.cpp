// Two sets of samples for each place, the same ones everywhere so that the field is smooth:
//   directions   even in the cone that holds the mesh; of little use for a small or thin light
//   surface      points even by area, seen where nothing is between; singular close to the surface
// combined by the balance heuristic (Veach and Guibas, "Optimally combining sampling techniques for
// Monte Carlo rendering", SIGGRAPH 1995): a sample along w counts L y(w) / (n_1 p_1(w) + n_2
// p_2(w)), with both densities p per sr.
#include "assetc/light/mesh_emitter.h"

#include "assetc/embree_scene.h"
#include "runtime/assert.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace penumbra {

namespace {

constexpr std::size_t kPacket = 16;
// A ray to a point of the surface ends this much before it, bounding radii.
constexpr float kRayGap = 1e-4f;
constexpr float kTwoPi = 2 * std::numbers::pi_v<float>;

struct Triangle {
    vec3 a, ab, ac;
};

Triangle triangleOf(const MeshAsset& mesh, std::size_t index)
{
    const vec3 a = mesh.positions[mesh.indices[3 * index]];
    return {a, mesh.positions[mesh.indices[3 * index + 1]] - a,
            mesh.positions[mesh.indices[3 * index + 2]] - a};
}

double areaOf(const Triangle& t)
{
    return 0.5 * glm::length(cross(glm::dvec3(t.ab), glm::dvec3(t.ac)));
}

// Any frame around the unit z: Duff et al., "Building an orthonormal basis, revisited", JCGT 6(1),
// 2017.
mat3 frameAround(vec3 z)
{
    const float sign = std::copysign(1.0f, z.z);
    const float a = -1 / (sign + z.z), b = z.x * z.y * a;
    return mat3(vec3(1 + sign * z.x * z.x * a, sign * b, -sign * z.x),
                vec3(b, sign + z.y * z.y * a, -z.y), z);
}

} // namespace

// What is added up for one place.
struct MeshEmitter::Sum {
    vec3 position{0};
    mat3 cone{1};             // z: its axis
    float coneSolidAngle = 0; // sr
    std::array<double, 16> sh{};
    std::array<double, 16> difference{}; // samples of even index less those of odd index

    // Sample `index` of a set, along the unit `w`, that meets the surface at `distance` under the
    // cosine `cosine`.
    void add(vec3 w, float distance, float cosine, float area, std::size_t samples,
             std::size_t index)
    {
        const double directions = 1.0 / coneSolidAngle;
        const double surface = double(distance) * distance / (double(area) * cosine);
        const double weight = 1 / ((directions + surface) * static_cast<double>(samples));
        const Sh4 basis = shBasis(w);
        for (std::size_t k = 0; k < 16; ++k) {
            const double value = weight * basis.c[k];
            sh[k] += value;
            difference[k] += index % 2 == 0 ? value : -value;
        }
    }
};

double surfaceArea(const MeshAsset& mesh)
{
    double area = 0;
    for (std::size_t i = 0; i < mesh.indices.size() / 3; ++i)
        area += areaOf(triangleOf(mesh, i));
    return area;
}

MeshEmitter::MeshEmitter(const MeshAsset& mesh, vec3 radiance, const Options& options)
    : m_bounds(boundingSphere(mesh.positions, 64)), m_radiance(radiance),
      m_twoSided(options.twoSided), m_area(static_cast<float>(surfaceArea(mesh))),
      m_points(options.samples / 2),
      m_scene(std::make_unique<const EmbreeScene>(mesh.positions, mesh.indices))
{
    PENUMBRA_ASSERT(options.samples >= 2 && !mesh.indices.empty(), "{} samples, {} indices",
                    options.samples, mesh.indices.size());
    // Fibonacci lattice: x even, y by the golden ratio.
    for (std::size_t i = 0; i < m_points.size(); ++i) {
        const double x = (static_cast<double>(i) + 0.5) / static_cast<double>(m_points.size());
        m_unitSquare.emplace_back(x, std::fmod(static_cast<double>(i) / std::numbers::phi, 1.0));
    }
    spreadPoints(mesh);
}

MeshEmitter::~MeshEmitter() = default;

// Equal steps along the running sum of areas, so neighbouring triangles share points fairly; within
// a triangle by the R2 sequence (Roberts 2018).
void MeshEmitter::spreadPoints(const MeshAsset& mesh)
{
    constexpr double kPlastic = 1.32471795724474602596;
    std::size_t triangle = 0;
    Triangle current = triangleOf(mesh, 0);
    double end = areaOf(current);
    for (std::size_t i = 0; i < m_points.size(); ++i) {
        const double target =
            (static_cast<double>(i) + 0.5) / static_cast<double>(m_points.size()) * m_area;
        while (end < target && triangle + 1 < mesh.indices.size() / 3) {
            current = triangleOf(mesh, ++triangle);
            end += areaOf(current);
        }
        double u = std::fmod(0.5 + static_cast<double>(i) / kPlastic, 1.0);
        double v = std::fmod(0.5 + static_cast<double>(i) / (kPlastic * kPlastic), 1.0);
        if (u + v > 1) {
            u = 1 - u;
            v = 1 - v;
        }
        m_points[i].position =
            current.a + current.ab * static_cast<float>(u) + current.ac * static_cast<float>(v);
        m_points[i].normal = vec3(normalize(cross(glm::dvec3(current.ab), glm::dvec3(current.ac))));
    }
}

void MeshEmitter::addDirections(Sum& sum) const
{
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    const float cap = sum.coneSolidAngle / kTwoPi; // 1 - cos of the half-angle
    for (std::size_t first = 0; first < m_unitSquare.size(); first += kPacket) {
        alignas(64) RTCRayHit16 rays{};
        alignas(64) std::array<int, kPacket> valid{};
        const std::size_t count = std::min(kPacket, m_unitSquare.size() - first);
        for (std::size_t k = 0; k < count; ++k) {
            const vec2 u = m_unitSquare[first + k];
            const float below = u.x * cap, s = std::sqrt(below * (2 - below));
            const vec3 w =
                sum.cone * vec3(s * std::cos(kTwoPi * u.y), s * std::sin(kTwoPi * u.y), 1 - below);
            valid[k] = -1;
            rays.ray.org_x[k] = sum.position.x;
            rays.ray.org_y[k] = sum.position.y;
            rays.ray.org_z[k] = sum.position.z;
            rays.ray.dir_x[k] = w.x;
            rays.ray.dir_y[k] = w.y;
            rays.ray.dir_z[k] = w.z;
            rays.ray.tfar[k] = std::numeric_limits<float>::infinity();
            rays.ray.mask[k] = ~0u;
            rays.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
        }
        rtcIntersect16(valid.data(), m_scene->handle(), &context, &rays);
        for (std::size_t k = 0; k < count; ++k) {
            if (rays.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID)
                continue;
            const vec3 w(rays.ray.dir_x[k], rays.ray.dir_y[k], rays.ray.dir_z[k]);
            const vec3 normal =
                normalize(vec3(rays.hit.Ng_x[k], rays.hit.Ng_y[k], rays.hit.Ng_z[k]));
            const float facing = -dot(normal, w);
            const float cosine = m_twoSided ? std::abs(facing) : facing;
            if (cosine > 0)
                sum.add(w, rays.ray.tfar[k], cosine, m_area, m_unitSquare.size(), first + k);
        }
    }
}

void MeshEmitter::addSurface(Sum& sum) const
{
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    struct Candidate {
        vec3 w;
        float distance, cosine;
        std::size_t index;
    };
    std::array<Candidate, kPacket> candidates;
    std::size_t count = 0;
    const auto flush = [&] {
        alignas(64) RTCRay16 rays{};
        alignas(64) std::array<int, kPacket> valid{};
        for (std::size_t k = 0; k < count; ++k) {
            valid[k] = -1;
            rays.org_x[k] = sum.position.x;
            rays.org_y[k] = sum.position.y;
            rays.org_z[k] = sum.position.z;
            rays.dir_x[k] = candidates[k].w.x;
            rays.dir_y[k] = candidates[k].w.y;
            rays.dir_z[k] = candidates[k].w.z;
            rays.tfar[k] = std::max(0.0f, candidates[k].distance - kRayGap * m_bounds.radius);
            rays.mask[k] = ~0u;
        }
        rtcOccluded16(valid.data(), m_scene->handle(), &context, &rays);
        for (std::size_t k = 0; k < count; ++k)
            if (!(rays.tfar[k] < 0)) // Embree's mark of a hit
                sum.add(candidates[k].w, candidates[k].distance, candidates[k].cosine, m_area,
                        m_points.size(), candidates[k].index);
        count = 0;
    };
    for (std::size_t i = 0; i < m_points.size(); ++i) {
        const SurfacePoint& point = m_points[i];
        const vec3 to = point.position - sum.position;
        const float distance = glm::length(to);
        if (!(distance > 0))
            continue;
        const vec3 w = to / distance;
        const float facing = -dot(point.normal, w);
        const float cosine = m_twoSided ? std::abs(facing) : facing;
        if (!(cosine > 0))
            continue;
        candidates[count++] = {w, distance, cosine, i};
        if (count == kPacket)
            flush();
    }
    if (count > 0)
        flush();
}

MeshEmitter::Sum MeshEmitter::sumAt(vec3 position) const
{
    Sum sum;
    sum.position = position;
    const vec3 toCenter = m_bounds.center - position;
    const float distance = glm::length(toCenter);
    if (distance > m_bounds.radius) {
        const float sine = m_bounds.radius / distance;
        sum.cone = frameAround(toCenter / distance);
        sum.coneSolidAngle = kTwoPi * sine * sine / (1 + std::sqrt(1 - sine * sine));
    } else {
        sum.coneSolidAngle = 2 * kTwoPi;
    }
    addDirections(sum);
    addSurface(sum);
    return sum;
}

RadianceSh MeshEmitter::colored(const std::array<double, 16>& sh) const
{
    RadianceSh result;
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t k = 0; k < 16; ++k)
            result[c].c[k] = static_cast<float>(sh[k] * m_radiance[static_cast<int>(c)]);
    return result;
}

RadianceSh MeshEmitter::radianceAt(vec3 position) const
{
    return colored(sumAt(position).sh);
}

// The estimates by either half are (sh ± difference); half of their difference is `difference`.
Emitter::Estimate MeshEmitter::estimateAt(vec3 position) const
{
    const Sum sum = sumAt(position);
    return {colored(sum.sh), colored(sum.difference)};
}

vec3 MeshEmitter::power() const
{
    return m_radiance * m_area * (std::numbers::pi_v<float> * (m_twoSided ? 2 : 1));
}

} // namespace penumbra
