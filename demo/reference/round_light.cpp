#include "demo/reference/round_light.h"

#include "demo/reference/sampling.h"
#include "demo/reference/shade_all.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numbers>

namespace penumbra {

namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kShort = 1e-4f; // a ray to a sphere ends this part before its surface
// Share of a full hemisphere's irradiance from which on rays follow the cosine: above it fewer rays
// miss the disc than even rays would lose to weights.
constexpr float kBroad = 0.75f;

// Rays of one receiver, in packets: sums of their weights, and of those that arrive.
class Rays {
public:
    Rays(const ReferenceScene& scene, vec3 origin) : m_scene(scene) { m_packet.origin = origin; }

    void add(vec3 direction, float distance, float weight)
    {
        const int lane = m_packet.count++;
        m_packet.directions[lane] = direction;
        m_packet.distances[lane] = distance;
        m_weights[lane] = weight;
        if (m_packet.count == ShadowPacket::kSize)
            flush();
    }

    void flush()
    {
        if (m_packet.count == 0)
            return;
        m_scene.occluded(m_packet);
        for (int i = 0; i < m_packet.count; ++i)
            arrived += m_packet.visible[i] ? m_weights[i] : 0.0f;
        count += static_cast<std::uint64_t>(m_packet.count);
        m_packet.count = 0;
    }

    double arrived = 0;
    std::uint64_t count = 0;

private:
    const ReferenceScene& m_scene;
    ShadowPacket m_packet;
    std::array<float, ShadowPacket::kSize> m_weights{};
};

ReferencePoint shadeOne(const ReferenceScene& scene, const RoundLight& light,
                        const ReferenceReceiver& receiver, const ReferenceOptions& options,
                        std::span<const glm::uvec2> points, std::size_t index)
{
    const vec3 origin =
        receiver.position + rayOffset(scene, receiver.instance, options) * receiver.normal;
    const RoundView view = light.seenFrom(origin);
    const float irradiance = roundIrradiance(view, receiver.normal);
    ReferencePoint point;
    if (irradiance <= 0.0f)
        return point;
    const std::uint32_t base =
        hashBits(static_cast<std::uint32_t>(index) + hashBits(options.seed + 1));
    const glm::uvec2 shift(base, hashBits(base + 0x9e3779b9u));
    const bool broad = irradiance > kBroad * kPi;
    const Frame frame(broad ? receiver.normal : view.axis);
    const float cosine = std::sqrt(max(0.0f, 1.0f - view.sine * view.sine));
    // 1 - cosine without cancellation: sine² / (1 + cosine).
    const float height = view.sine * view.sine / (1.0f + cosine);
    Rays rays(scene, origin);
    double all = 0, risen = 0; // weights: of the disc, and of what of it gives light
    for (const glm::uvec2 p : points) {
        const vec2 u = scramble(p, shift);
        const float z = broad ? std::sqrt(u.x) : 1.0f - u.x * height;
        const float radius = std::sqrt(max(0.0f, 1.0f - z * z)), phi = 2.0f * kPi * u.y;
        const vec3 direction = frame.toWorld({radius * std::cos(phi), radius * std::sin(phi), z});
        const float along = dot(receiver.normal, direction);
        const bool inside = broad ? dot(view.axis, direction) >= cosine : along > 0.0f;
        if (!inside)
            continue;
        const float weight = broad ? 1.0f : along;
        all += weight;
        if (!light.isSphere() && direction.y < 0.0f)
            continue;
        risen += weight;
        rays.add(direction, light.distance(origin, direction), weight);
    }
    rays.flush();
    point.rays = rays.count;
    // A disc of which no sample rose is a sliver: it counts as if nothing stood in the way.
    const double full = irradiance * light.radiance() / kPi;
    const vec3 albedo = scene.materials()[receiver.material].albedo;
    point.unshadowed = glm::dvec3(albedo) * (all > 0 ? full * risen / all : full);
    point.shadowed = glm::dvec3(albedo) * (all > 0 ? full * rays.arrived / all : full);
    return point;
}

} // namespace

RoundLight RoundLight::cap(vec3 axis, float sineOfHalfAngle, float radiance)
{
    RoundLight light;
    light.m_place = axis;
    light.m_sine = sineOfHalfAngle;
    light.m_radiance = radiance;
    return light;
}

RoundLight RoundLight::sphere(vec3 center, float radius, float radiance)
{
    RoundLight light;
    light.m_place = center;
    light.m_radius = radius;
    light.m_radiance = radiance;
    return light;
}

RoundView RoundLight::seenFrom(vec3 point) const
{
    if (!isSphere())
        return {m_place, m_sine};
    const vec3 to = m_place - point;
    const float apart = length(to);
    return {to / apart, std::min(m_radius / apart, 1.0f)};
}

float RoundLight::distance(vec3 point, vec3 direction) const
{
    if (!isSphere())
        return std::numeric_limits<float>::infinity();
    const vec3 to = m_place - point;
    const float along = dot(to, direction);
    const vec3 beside = to - along * direction;
    const float inside = m_radius * m_radius - dot(beside, beside); // < 0 by rounding at the rim
    return (along - std::sqrt(max(inside, 0.0f))) * (1.0f - kShort);
}

float roundIrradiance(const RoundView& view, vec3 normal)
{
    const float sine2 = view.sine * view.sine;
    const float cosine = clamp(dot(view.axis, normal), -1.0f, 1.0f);
    if (cosine >= 0.0f && cosine * cosine >= sine2)
        return kPi * sine2 * cosine;
    if (cosine < 0.0f && cosine * cosine >= sine2)
        return 0.0f;
    const float across = std::sqrt(1.0f - cosine * cosine);
    const float x = std::sqrt(1.0f / sine2 - 1.0f);
    const float y = clamp(-x * cosine / across, -1.0f, 1.0f);
    const float s = across * std::sqrt(1.0f - y * y);
    return max(0.0f, (cosine * std::acos(y) - x * s) * sine2 + std::atan2(s, x));
}

ReferenceRadiance shadeRound(const ReferenceScene& scene, const RoundLight& light,
                             std::span<const ReferenceReceiver> receivers,
                             const ReferenceOptions& options)
{
    const std::vector<glm::uvec2> points =
        makeSamplePoints(std::bit_ceil(std::max(options.samples, 1u)));
    return shadeAll(receivers.size(), [&](std::size_t i) {
        return shadeOne(scene, light, receivers[i], options, points, i);
    });
}

} // namespace penumbra
