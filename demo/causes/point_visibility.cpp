#include "demo/causes/point_visibility.h"

#include "shaders/shared/instance.h"

#include <algorithm>
#include <limits>
#include <numbers>

namespace penumbra {

namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kBlind = 0.01f; // mean visibility of a node that lies inside the object

// Deviation in steps: by band over bandScale * g.
Sh4 inSteps(Sh4 deviation, vec4 scale)
{
    return fieldDeviation(deviation, 1.0f / scale);
}

Sh4 rounded(Sh4 steps)
{
    for (float& c : steps.c)
        c = std::clamp(std::round(c), -128.0f, 127.0f);
    return steps;
}

void addScaled(Sh4& sum, const Sh4& f, float factor)
{
    for (int k = 0; k < 16; ++k)
        sum.c[k] += factor * f.c[k];
}

} // namespace

Result<PointVisibility> PointVisibility::make(const MeshAsset& mesh, const mat4& worldFromObject,
                                              vec4 sphere)
{
    const ReferenceInstance instance{&mesh, worldFromObject, 0};
    const std::vector<MeshMaterial> materials(1);
    Result<ReferenceScene> scene = ReferenceScene::build(std::span(&instance, 1), materials);
    if (!scene)
        return scene.error();
    return PointVisibility(std::move(*scene), sphere);
}

Sh4 PointVisibility::at(vec3 point, std::span<const glm::uvec2> points, glm::uvec2 shift) const
{
    const vec3 to = vec3(m_sphere) - point;
    const float apart = length(to);
    const bool outside = apart > 1.001f * m_sphere.w;
    const float sine = outside ? m_sphere.w / apart : 1;
    const float height = outside ? sine * sine / (1 + std::sqrt(1 - sine * sine)) : 2;
    return within(point, outside ? to / apart : vec3(0, 1, 0), height, points, shift);
}

Sh4 PointVisibility::above(vec3 point, vec3 normal, std::span<const glm::uvec2> points,
                           glm::uvec2 shift) const
{
    return within(point, normal, 1, points, shift);
}

Sh4 PointVisibility::within(vec3 point, vec3 axis, float height, std::span<const glm::uvec2> points,
                            glm::uvec2 shift) const
{
    const Frame frame(axis);
    const float weight = 2 * kPi * height / static_cast<float>(points.size());
    Sh4 visibility{};
    visibility.c[0] = kSqrt4Pi;
    ShadowPacket packet;
    packet.origin = point;
    packet.distances.fill(std::numeric_limits<float>::infinity());
    const auto flush = [&] {
        m_scene.occluded(packet);
        for (int i = 0; i < packet.count; ++i)
            if (!packet.visible[i])
                addScaled(visibility, shBasis(packet.directions[i]), -weight);
        packet.count = 0;
    };
    for (const glm::uvec2 p : points) {
        const vec2 u = scramble(p, shift);
        const float z = 1 - u.x * height, radius = std::sqrt(max(0.0f, 1 - z * z));
        const float phi = 2 * kPi * u.y;
        packet.directions[packet.count] =
            frame.toWorld({radius * std::cos(phi), radius * std::sin(phi), z});
        if (++packet.count == ShadowPacket::kSize)
            flush();
    }
    if (packet.count > 0)
        flush();
    return visibility;
}

TracedCell traceCell(const PointVisibility& object, const FieldEntity& entity,
                     const FieldCell& cell, Kernel kernel, std::span<const glm::uvec2> points,
                     glm::uvec2 shift)
{
    const FieldGrid& grid = entity.grid;
    std::array<std::pair<std::uint32_t, float>, 8> corners{}; // offset, weight
    if (kernel == Kernel::Literal) {
        for (std::uint32_t i = 0; i < 8; ++i)
            corners[i] = {fieldCornerOffset(i, grid), fieldCornerWeight(i, cell.fraction)};
    } else {
        const FieldTetrahedron t = fieldTetrahedron(cell.fraction, grid);
        for (int i = 0; i < 4; ++i)
            corners[static_cast<std::size_t>(i)] = {t.offset[i],
                                                    static_cast<float>(t.weight[i]) / 256};
    }
    const mat3 worldFromRadii = glm::inverse(entity.radiiFromWorld);
    TracedCell sum;
    float used = 0;
    for (const auto& [offset, weight] : corners) {
        if (weight <= 0)
            continue;
        const std::uint32_t node = cell.sample0 + offset - grid.firstSample;
        const std::uint32_t shell = node % grid.shells, column = node / grid.shells;
        const vec2 uv =
            vec2(column % grid.side, column / grid.side) / static_cast<float>(grid.side - 1);
        const float radius =
            std::exp2((static_cast<float>(shell) - grid.shellBias) / grid.shellScale);
        const vec3 place = entity.center + worldFromRadii * (radius * octahedralDirection(uv));
        Sh4 deviation = object.at(place, points, {shift.x ^ hashBits(node), shift.y});
        if (deviation.c[0] < kBlind * kSqrt4Pi)
            continue;
        deviation.c[0] -= kSqrt4Pi;
        const Sh4 steps = inSteps(shRotate(deviation, shInverse(entity.rotation)),
                                  entity.bandScale * fieldDecay(radius * radius));
        addScaled(sum.plain, steps, weight);
        addScaled(sum.rounded, rounded(steps), weight);
        used += weight;
    }
    if (used > 0)
        for (int k = 0; k < 16; ++k) {
            sum.plain.c[k] /= used;
            sum.rounded.c[k] /= used;
        }
    return sum;
}

} // namespace penumbra
