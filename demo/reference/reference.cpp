#include "demo/reference/reference.h"

#include "demo/reference/sampling.h"
#include "demo/reference/shade_all.h"

#include <bit>
#include <limits>

namespace penumbra {

namespace {

constexpr float kShort = 1e-4f; // a ray to a light ends this part before its surface

using Point = ReferencePoint;

class Integrator {
public:
    Integrator(const ReferenceScene& scene, const ReferenceLighting& lighting,
               const ReferenceOptions& options)
        : m_scene(scene), m_lighting(lighting), m_seed(options.seed),
          m_points(makeSamplePoints(std::bit_ceil(std::max(options.samples, 2u)) / 2))
    {}

    // `origin` is off the surface already.
    [[nodiscard]] Point shade(vec3 origin, const ReferenceReceiver& receiver,
                              std::size_t index) const
    {
        Point point;
        const MeshMaterial& material = m_scene.materials()[receiver.material];
        const Reflectance reflectance(receiver.normal, receiver.toEye, material);
        Pending pending;
        pending.packet.origin = origin;
        if (!m_lighting.sky.black())
            addSky(pending, point, reflectance, index);
        for (std::size_t l = 0; l < m_lighting.lights.size(); ++l)
            if (m_lighting.lights[l].instance() != receiver.instance)
                addLight(pending, point, reflectance, index, l);
        flush(pending, point);
        point.shadowed *= glm::dvec3(material.albedo);
        point.unshadowed *= glm::dvec3(material.albedo);
        return point;
    }

private:
    struct Pending {
        ShadowPacket packet;
        std::array<vec3, ShadowPacket::kSize> contributions{};
    };

    void add(Pending& pending, Point& point, vec3 direction, float distance,
             vec3 contribution) const
    {
        point.unshadowed += glm::dvec3(contribution);
        const int lane = pending.packet.count++;
        pending.packet.directions[lane] = direction;
        pending.packet.distances[lane] = distance;
        pending.contributions[lane] = contribution;
        if (pending.packet.count == ShadowPacket::kSize)
            flush(pending, point);
    }

    void addSky(Pending& pending, Point& point, const Reflectance& reflectance,
                std::size_t index) const
    {
        constexpr float kForever = std::numeric_limits<float>::infinity();
        const auto count = static_cast<float>(m_points.size());
        const auto addFrom = [&](vec3 direction, const ReferenceLight::Value& light,
                                 const Reflectance::Value& r) {
            add(pending, point, direction, kForever,
                light.radiance * (r.f / (count * (light.pdf + r.pdf))));
        };
        const ReferenceLight& sky = m_lighting.sky;
        const glm::uvec2 lightShift = shift(index, 0), reflectanceShift = shift(index, 1);
        for (const glm::uvec2 p : m_points) {
            const ReferenceLight::Sample sample = sky.sample(scramble(p, lightShift));
            const Reflectance::Value r = reflectance.evaluate(sample.direction);
            if (r.f > 0.0f)
                addFrom(sample.direction, sky.evaluate(sample), r);
        }
        for (const glm::uvec2 p : m_points) {
            const vec3 direction = reflectance.sample(scramble(p, reflectanceShift));
            const Reflectance::Value r = reflectance.evaluate(direction);
            if (r.f > 0.0f)
                addFrom(direction, sky.evaluate(direction), r);
        }
    }

    // The surface's area over the number of points, seen from the receiver.
    void addLight(Pending& pending, Point& point, const Reflectance& reflectance, std::size_t index,
                  std::size_t l) const
    {
        const AreaLight& light = m_lighting.lights[l];
        const float area = light.area() / static_cast<float>(2 * m_points.size());
        for (std::uint32_t half = 0; half < 2; ++half) {
            const glm::uvec2 by = shift(index, 2 + 2 * static_cast<std::uint32_t>(l) + half);
            for (const glm::uvec2 p : m_points) {
                const AreaLight::Sample sample = light.sample(scramble(p, by));
                const vec3 to = sample.position - pending.packet.origin;
                const float distance = length(to);
                const vec3 direction = to / distance;
                const Reflectance::Value r = reflectance.evaluate(direction);
                const AreaLight::Emission e =
                    light.emission(sample.triangle, sample.barycentric, -direction);
                if (r.f > 0.0f && e.cosine > 0.0f)
                    add(pending, point, direction, distance * (1.0f - kShort),
                        e.radiance * (r.f * e.cosine * area / (distance * distance)));
            }
        }
    }

    void flush(Pending& pending, Point& point) const
    {
        if (pending.packet.count == 0)
            return;
        m_scene.occluded(pending.packet);
        for (int i = 0; i < pending.packet.count; ++i)
            if (pending.packet.visible[i])
                point.shadowed += glm::dvec3(pending.contributions[i]);
        point.rays += static_cast<std::uint64_t>(pending.packet.count);
        pending.packet.count = 0;
    }

    [[nodiscard]] glm::uvec2 shift(std::size_t index, std::uint32_t stream) const
    {
        const std::uint32_t base =
            hashBits(static_cast<std::uint32_t>(index) + hashBits(hashBits(m_seed + 1) + stream));
        return {base, hashBits(base + 0x9e3779b9u)};
    }

    const ReferenceScene& m_scene;
    const ReferenceLighting& m_lighting;
    std::uint32_t m_seed;
    std::vector<glm::uvec2> m_points; // one half of the samples; the other half has other shifts
};

} // namespace

ReferenceRadiance shadeReference(const ReferenceScene& scene, const ReferenceLighting& lighting,
                                 std::span<const ReferenceReceiver> receivers,
                                 const ReferenceOptions& options)
{
    for (const ReferenceReceiver& r : receivers)
        PENUMBRA_ASSERT(r.material < scene.materials().size(), "material {} of {}", r.material,
                        scene.materials().size());
    const Integrator integrator(scene, lighting, options);
    return shadeAll(receivers.size(), [&](std::size_t i) {
        const ReferenceReceiver& r = receivers[i];
        return integrator.shade(r.position + rayOffset(scene, r.instance, options) * r.normal, r,
                                i);
    });
}

vec3 pixelDirection(const ReferenceCamera& camera, std::size_t pixel)
{
    const vec2 size(camera.width, camera.height);
    const vec2 ndc = 2.0f * (vec2(pixel % camera.width, pixel / camera.width) + 0.5f) / size - 1.0f;
    const vec4 middle =
        camera.worldFromClip * vec4(ndc, 0.5f, 1.0f); // finite for both directions of depth
    return normalize(vec3(middle) / middle.w - camera.eye);
}

ReferencePicture renderReference(const ReferenceScene& scene, const ReferenceLighting& lighting,
                                 const ReferenceCamera& camera, const ReferenceOptions& options)
{
    const std::size_t count = std::size_t{camera.width} * camera.height;
    const Integrator integrator(scene, lighting, options);
    ReferencePicture picture;
    picture.instance.assign(count, kNoInstance);
    picture.emission.assign(count, vec3(0));
    picture.radiance = shadeAll(count, [&](std::size_t i) {
        const vec3 direction = pixelDirection(camera, i);
        const ReferenceHit hit = scene.closest(camera.eye, direction);
        if (!hit.hit) {
            const glm::dvec3 sky(lighting.sky.evaluate(direction).radiance);
            return Point{sky, sky, 0};
        }
        picture.instance[i] = hit.instance;
        const ReferenceReceiver receiver{hit.position, hit.normal, -direction,
                                         scene.instances()[hit.instance].material, hit.instance};
        const float distance = rayOffset(scene, hit.instance, options);
        Point point = integrator.shade(hit.position + distance * hit.faceNormal, receiver, i);
        for (const AreaLight& light : lighting.lights)
            if (light.instance() == hit.instance) {
                const glm::dvec3 own(
                    light.emission(hit.triangle, hit.barycentric, -direction).radiance);
                point.shadowed += own;
                point.unshadowed += own;
                picture.emission[i] += vec3(own);
            }
        return point;
    });
    return picture;
}

} // namespace penumbra
