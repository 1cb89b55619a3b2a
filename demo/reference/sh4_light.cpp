#include "demo/reference/sh4_light.h"

#include "demo/reference/sampling.h"
#include "demo/reference/shade_all.h"
#include "shaders/shared/sh.h"

#include <algorithm>
#include <bit>
#include <numbers>

namespace penumbra {

namespace {

constexpr float kPi = std::numbers::pi_v<float>;

glm::uvec2 shiftOf(std::size_t index, std::uint32_t seed)
{
    const std::uint32_t base =
        hashBits(static_cast<std::uint32_t>(index) + hashBits(seed + 0x51ed270bu));
    return {base, hashBits(base + 0x9e3779b9u)};
}

vec3 radianceOf(const Sh4Light& light, vec3 direction)
{
    const Sh4 basis = shBasis(direction);
    vec3 radiance(0);
    for (std::size_t k = 0; k < light.radiance.size(); ++k)
        radiance += basis.c[k] * light.radiance[k];
    return radiance;
}

ReferencePoint shadeOne(const ReferenceScene& scene, const Sh4Light& light,
                        const ReferenceReceiver& receiver, float offset,
                        std::span<const glm::uvec2> points, glm::uvec2 shift)
{
    const MeshMaterial& material = scene.materials()[receiver.material];
    const Reflectance reflectance(receiver.normal, receiver.toEye, material);
    ReferencePoint point;
    ShadowPacket packet;
    packet.origin = receiver.position + offset * receiver.normal;
    packet.distances.fill(light.reach);
    std::array<vec3, ShadowPacket::kSize> contributions{};
    const auto flush = [&] {
        if (packet.count == 0)
            return;
        scene.occluded(packet);
        for (int i = 0; i < packet.count; ++i)
            if (packet.visible[i])
                point.shadowed += glm::dvec3(contributions[i]);
        point.rays += static_cast<std::uint64_t>(packet.count);
        packet.count = 0;
    };
    const vec3 scale = material.albedo / static_cast<float>(points.size());
    for (const glm::uvec2 p : points) {
        const vec3 direction = reflectance.sample(scramble(p, shift));
        const Reflectance::Value r = reflectance.evaluate(direction);
        if (r.f <= 0.0f)
            continue;
        const vec3 contribution = scale * (r.f / r.pdf) * radianceOf(light, direction);
        point.unshadowed += glm::dvec3(contribution);
        packet.directions[packet.count] = direction;
        contributions[packet.count] = contribution;
        if (++packet.count == ShadowPacket::kSize)
            flush();
    }
    flush();
    return point;
}

} // namespace

Sh4Light sh4Of(const RoundLight& light, vec3 point)
{
    const RoundView view = light.seenFrom(point);
    // Integrals of P_l over the disc, 2 pi times [(P_{l-1} - P_{l+1}) / (2l + 1)] at its rim.
    const float z = std::sqrt(max(0.0f, 1.0f - view.sine * view.sine));
    const float s2 = view.sine * view.sine;
    const vec4 zonal =
        2.0f * kPi * light.radiance() *
        vec4(s2 / (1.0f + z), 0.5f * s2, 0.5f * z * s2, 0.125f * s2 * (5.0f * z * z - 1.0f));
    const Sh4 grey = shZonal(view.axis, zonal);
    Sh4Light sh;
    for (std::size_t k = 0; k < sh.radiance.size(); ++k)
        sh.radiance[k] = vec3(grey.c[k]);
    if (light.isSphere())
        sh.reach = light.distance(point, view.axis);
    return sh;
}

Sh4Light sh4Of(const AreaLight& light, vec3 point, std::uint32_t samples)
{
    Sh4Light sh;
    const std::vector<glm::uvec2> points = makeSamplePoints(std::bit_ceil(samples));
    const float area = light.area() / static_cast<float>(points.size());
    for (const glm::uvec2 p : points) {
        const AreaLight::Sample at = light.sample(scramble(p, glm::uvec2(0)));
        const vec3 to = at.position - point;
        const float distance = length(to);
        const AreaLight::Emission e = light.emission(at.triangle, at.barycentric, -to / distance);
        if (e.cosine <= 0.0f)
            continue;
        sh.reach = std::min(sh.reach, distance);
        const Sh4 basis = shBasis(to / distance);
        for (std::size_t k = 0; k < sh.radiance.size(); ++k)
            sh.radiance[k] += basis.c[k] * e.cosine * area / (distance * distance) * e.radiance;
    }
    constexpr float kBetweenPoints = 0.02f; // of a side: how much nearer the surface may come
    sh.reach = max(0.0f, sh.reach - kBetweenPoints * std::sqrt(light.area()));
    return sh;
}

ReferenceRadiance shadeSh4(const ReferenceScene& scene,
                           const std::function<Sh4Light(const ReferenceReceiver&)>& light,
                           std::span<const ReferenceReceiver> receivers,
                           const ReferenceOptions& options, std::uint32_t dark)
{
    const std::vector<glm::uvec2> points =
        makeSamplePoints(std::bit_ceil(std::max(options.samples, 1u)));
    return shadeAll(receivers.size(), [&](std::size_t i) {
        const ReferenceReceiver& r = receivers[i];
        if (dark != kNoInstance && r.instance == dark)
            return ReferencePoint{};
        return shadeOne(scene, light(r), r, rayOffset(scene, r.instance, options), points,
                        shiftOf(i, options.seed));
    });
}

} // namespace penumbra
