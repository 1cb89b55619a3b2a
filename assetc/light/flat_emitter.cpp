// Integration over the surface by cells of a quadtree that are small against their distance, each
// with the mean radiance of its part of the picture, and the 2 x 2 Gauss rule where that is one
// pixel. No random numbers, so the field is as smooth as the light.
#include "assetc/light/flat_emitter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace penumbra {

namespace {

constexpr int kPictureLevel = 8; // 256 x 256 cells: order 4 sees no finer detail
constexpr int kFirstLevel = 1;   // a distant light is still 4 cells, so that its shape counts
constexpr int kLastLevel = 14; // cells of 1e-4: nodes of a 257 grid are 5e-4 off the plane or on it
// Half a cell's diagonal over its distance. Geometry alone: the irradiance of a rectangle is then
// within 2.5e-3 of the closed form, half a step of the 8 bits. Where a cell averages pixels, their
// places within it count; it is then so small that its centre will do.
constexpr double kCellAngle = 0.3, kPictureCellAngle = 0.1;
constexpr double kStretch = 1.39; // largest singular value of the concentric map
constexpr double kGauss[2] = {0.5 - 0.5 / std::numbers::sqrt3, 0.5 + 0.5 / std::numbers::sqrt3};

// Concentric map of [-1, 1]^2 to the unit disc, equal areas: Shirley and Chiu, "A low distortion
// map between disk and square", JGT 2(3), 1997.
glm::dvec2 concentric(glm::dvec2 s)
{
    if (s == glm::dvec2(0))
        return s;
    const bool steep = std::abs(s.y) > std::abs(s.x);
    const double r = steep ? s.y : s.x;
    const double angle = std::numbers::pi / 4 * (steep ? 2 - s.x / s.y : s.y / s.x);
    return r * glm::dvec2(std::cos(angle), std::sin(angle));
}

} // namespace

double SpotCone::falloff(double cosine) const
{
    const double t = std::clamp((cosine - cosOuter) / (cosInner - cosOuter), 0.0, 1.0);
    return t * t;
}

double SpotCone::solidAngle() const
{
    return 2 * std::numbers::pi * (1 - cosInner + (cosInner - cosOuter) / 3);
}

// What radianceAt adds up for one place.
struct FlatEmitter::Sum {
    glm::dvec3 position;
    std::size_t channels; // 1 without a picture: the others are the same
    std::array<std::array<double, 16>, 3> sh{};
};

Result<FlatEmitter> FlatEmitter::make(const LightSpec& spec, const LightPicture* picture)
{
    FlatEmitter emitter;
    emitter.m_round = spec.shape != EmitterShape::Rectangle;
    emitter.m_twoSided = spec.twoSided;
    emitter.m_half = emitter.m_round ? glm::dvec2(spec.radius) : glm::dvec2(spec.size) / 2.0;
    emitter.m_pyramid = {{vec3(1)}};
    if (picture)
        emitter.paint(*picture);
    if (spec.shape == EmitterShape::Spot) {
        const double radians = std::numbers::pi / 180;
        emitter.m_cone =
            SpotCone{std::cos(spec.innerAngle * radians), std::cos(spec.outerAngle * radians)};
    }
    if (spec.unit == EmissionUnit::Radiance) {
        emitter.m_scale = spec.emission;
    } else if (spec.unit == EmissionUnit::Intensity) {
        emitter.m_scale = spec.emission / static_cast<float>(emitter.area());
    } else {
        emitter.m_scale = vec3(1);
        const vec3 unit = emitter.power();
        for (int c = 0; c < 3; ++c) {
            if (!(unit[c] > 0) && spec.emission[c] > 0)
                return Error{fmt::format("power[{}] is {} W, but the texture is black there; "
                                         "give radiance",
                                         c, spec.emission[c])};
            emitter.m_scale[c] = unit[c] > 0 ? spec.emission[c] / unit[c] : 0;
        }
    }
    for (const vec3& pixel : emitter.m_pyramid.back())
        for (int c = 0; c < 3; ++c)
            if (!(pixel[c] * emitter.m_scale[c] <= kMaxRadiance))
                return Error{fmt::format("a radiance of {} W/(m² sr), at most {}; make the light "
                                         "weaker or larger",
                                         pixel[c] * emitter.m_scale[c], kMaxRadiance)};
    return emitter;
}

glm::dvec2 FlatEmitter::place(glm::dvec2 uv) const
{
    const glm::dvec2 s = uv * 2.0 - 1.0;
    return (m_round ? concentric(s) : s) * m_half;
}

double FlatEmitter::area() const
{
    return m_half.x * m_half.y * (m_round ? std::numbers::pi : 4);
}

// Cells of the last level are means over samples at least as dense as the picture's pixels.
void FlatEmitter::paint(const LightPicture& picture)
{
    constexpr std::uint32_t kSide = 1u << kPictureLevel;
    const std::uint32_t samples =
        std::clamp((std::max(picture.width, picture.height) + kSide - 1) / kSide, 4u, 16u);
    m_pyramid.assign(kPictureLevel + 1, {});
    m_pyramid.back().resize(std::size_t{kSide} * kSide);
    const auto pixelAt = [&](glm::dvec2 uv) {
        // Seen from +z with +y up: x to the right, row 0 at the top.
        const glm::dvec2 at = clamp(place(uv) / m_half * 0.5 + 0.5, 0.0, 1.0);
        const auto x = static_cast<std::uint32_t>(at.x * picture.width);
        const auto y = static_cast<std::uint32_t>((1 - at.y) * picture.height);
        return picture.pixels[std::size_t{std::min(y, picture.height - 1)} * picture.width +
                              std::min(x, picture.width - 1)];
    };
    for (std::uint32_t y = 0; y < kSide; ++y)
        for (std::uint32_t x = 0; x < kSide; ++x) {
            glm::dvec3 sum(0);
            for (std::uint32_t j = 0; j < samples; ++j)
                for (std::uint32_t i = 0; i < samples; ++i)
                    sum += pixelAt((glm::dvec2(x, y) + (glm::dvec2(i, j) + 0.5) / double(samples)) /
                                   double(kSide));
            m_pyramid.back()[std::size_t{y} * kSide + x] = sum / double(samples * samples);
        }
    for (int level = kPictureLevel - 1; level >= 0; --level) {
        const std::size_t side = std::size_t{1} << level;
        const std::vector<vec3>& fine = m_pyramid[static_cast<std::size_t>(level) + 1];
        std::vector<vec3>& coarse = m_pyramid[static_cast<std::size_t>(level)];
        for (std::size_t y = 0; y < side; ++y)
            for (std::size_t x = 0; x < side; ++x) {
                const vec3* at = &fine[4 * side * y + 2 * x];
                coarse.push_back((at[0] + at[1] + at[2 * side] + at[2 * side + 1]) * 0.25f);
            }
    }
}

vec3 FlatEmitter::cell(int level, std::uint32_t x, std::uint32_t y) const
{
    const int last = static_cast<int>(m_pyramid.size()) - 1;
    const int stored = std::min(level, last), shift = level - stored;
    return m_pyramid[static_cast<std::size_t>(stored)]
                    [(std::size_t{y >> shift} << stored) + (x >> shift)];
}

void FlatEmitter::addPoint(glm::dvec2 at, double area, vec3 radiance, Sum& sum) const
{
    const glm::dvec3 to = glm::dvec3(at, 0) - sum.position;
    const double d2 = dot(to, to), d = std::sqrt(d2);
    const double cosine = std::abs(to.z) / d;
    // A spot's radiance is I(a) / (area cos a): the cosine cancels.
    const double geometry = m_cone ? m_cone->falloff(cosine) : cosine;
    if (!(d2 > 0) || geometry <= 0)
        return;
    const double weight = geometry / d2 * area;
    const Sh4 basis = shBasis(vec3(to / d));
    for (std::size_t c = 0; c < sum.channels; ++c) {
        const double w = weight * radiance[static_cast<int>(c)];
        for (std::size_t k = 0; k < 16; ++k)
            sum.sh[c][k] += w * basis.c[k];
    }
}

void FlatEmitter::integrate(int level, std::uint32_t x, std::uint32_t y, Sum& sum) const
{
    const vec3 radiance = cell(level, x, y);
    if (radiance == vec3(0))
        return;
    const double side = 1.0 / static_cast<double>(1u << level);
    const glm::dvec2 center = place(glm::dvec2(x + 0.5, y + 0.5) * side);
    const double size = glm::length(m_half) * side; // half the diagonal
    const double far = distance(glm::dvec3(center, 0), sum.position);
    if (m_cone && kStretch * size < far) { // all of the cell sees the place outside the cone
        const double angle = std::acos(sum.position.z / far) - std::asin(kStretch * size / far);
        if (angle >= std::acos(m_cone->cosOuter))
            return;
    }
    const double cellArea = area() * side * side;
    const bool averages = level + 1 < static_cast<int>(m_pyramid.size());
    if (level >= kFirstLevel && averages && size <= kPictureCellAngle * far) {
        addPoint(center, cellArea, radiance, sum);
    } else if (level == kLastLevel ||
               (level >= kFirstLevel && size <= kCellAngle * far && !averages)) {
        for (const double v : kGauss)
            for (const double u : kGauss)
                addPoint(place(glm::dvec2(x + u, y + v) * side), cellArea / 4, radiance, sum);
    } else {
        for (std::uint32_t child = 0; child < 4; ++child)
            integrate(level + 1, 2 * x + (child & 1), 2 * y + (child >> 1), sum);
    }
}

Sphere FlatEmitter::bounds() const
{
    return {vec3(0), static_cast<float>(m_round ? m_half.x : glm::length(m_half))};
}

RadianceSh FlatEmitter::radianceAt(vec3 position) const
{
    RadianceSh result{};
    // In its own plane, too, a flat light is not seen.
    if (m_twoSided ? position.z == 0 : position.z <= 0)
        return result;
    const bool plain = m_pyramid.size() == 1;
    Sum sum{position, plain ? 1u : 3u};
    integrate(0, 0, 0, sum);
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t k = 0; k < 16; ++k)
            result[c].c[k] =
                static_cast<float>(sum.sh[plain ? 0 : c][k] * m_scale[static_cast<int>(c)]);
    return result;
}

vec3 FlatEmitter::power() const
{
    const double perArea = m_cone ? m_cone->solidAngle() : std::numbers::pi * (m_twoSided ? 2 : 1);
    return m_scale * m_pyramid.front().front() * static_cast<float>(area() * perArea);
}

} // namespace penumbra
