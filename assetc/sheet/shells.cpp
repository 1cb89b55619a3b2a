#include "assetc/sheet/shells.h"

#include "assetc/bake/directions.h"
#include "assetc/trace_visibility.h"
#include "assets/environment.h"
#include "shaders/shared/field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace penumbra {

namespace {

constexpr int kErrorPoints = 64;
constexpr std::uint32_t kMostDirections = 2048;
constexpr float kSeesNothing = 0.0005f * kSqrt4Pi; // c_0 of a point inside the object

vec3 randomDirection(std::mt19937& random)
{
    constexpr float kUnit = 1.0f / 4294967296.0f;
    const float z = 2 * static_cast<float>(random()) * kUnit - 1;
    const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(random()) * kUnit;
    const float r = std::sqrt(std::max(1 - z * z, 0.0f));
    return vec3(r * std::cos(angle), r * std::sin(angle), z);
}

} // namespace

Shells::Shells(const ShadowField& field) : m_field(field), m_side(largestSide(field))
{
    for (std::size_t channel = 0; channel < field.channels; ++channel)
        m_texels.push_back(refineField(field, channel));
}

const std::uint8_t* Shells::texel(std::size_t channel, std::size_t shell, std::size_t x,
                                  std::size_t y) const
{
    return &m_texels[channel][((shell * m_side + y) * m_side + x) * kFieldCoefficients];
}

vec3 Shells::mean(std::size_t shell, std::size_t x, std::size_t y) const
{
    const float scale = shellStep(m_field, shell).x / kSqrt4Pi;
    vec3 value(0);
    for (std::size_t i = 0; i < 3; ++i)
        value[static_cast<int>(i)] =
            scale * (static_cast<float>(*texel(i % m_field.channels, shell, x, y)) - 128.0f);
    return m_field.kind == FieldKind::Occlusion ? value + vec3(1) : value;
}

Shells::Range Shells::range(std::size_t shell) const
{
    Range range{std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest()};
    for (std::size_t y = 0; y < m_side; ++y)
        for (std::size_t x = 0; x < m_side; ++x) {
            const float value = luminance(mean(shell, x, y));
            range.low = std::min(range.low, value);
            range.high = std::max(range.high, value);
        }
    return range;
}

Canvas Shells::draw(std::size_t shell, int size) const
{
    const std::size_t own = m_field.shellSides[shell];
    const std::size_t side = own == 0 ? m_side : own;
    const std::size_t step = (m_side - 1) / (side - 1); // sides are 2^k + 1
    float brightest = 0;
    if (m_field.kind == FieldKind::Radiance)
        for (std::size_t y = 0; y < m_side; ++y)
            for (std::size_t x = 0; x < m_side; ++x) {
                const vec3 value = mean(shell, x, y);
                brightest = std::max({brightest, value.x, value.y, value.z});
            }
    Canvas canvas(size, size);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const auto node = [&](int at) {
                return static_cast<std::size_t>(at) * side / static_cast<std::size_t>(size) * step;
            };
            const vec3 value = mean(shell, node(x), node(y));
            if (m_field.kind == FieldKind::Radiance) {
                canvas.at(x, y) = displayColor(value / std::max(brightest, 1e-30f));
                continue;
            }
            // The root keeps the differences of far shells, which all but see everything, visible.
            const float blocked = std::clamp(1 - value.x, 0.0f, 1.0f);
            const auto grey = static_cast<std::uint8_t>(255 * (1 - std::sqrt(blocked)) + 0.5f);
            canvas.at(x, y) = {grey, grey, grey};
        }
    return canvas;
}

float Shells::tracedError(std::size_t shell, const EmbreeScene& scene) const
{
    const std::uint32_t count = m_field.directions == 0
                                    ? kMostDirections
                                    : std::clamp(m_field.directions & ~1u, 2u, kMostDirections);
    const std::vector<vec3> directions = bakeDirections(count);
    std::vector<Sh4> basis;
    for (const vec3 direction : directions)
        basis.push_back(shBasis(direction));

    std::mt19937 random(static_cast<std::uint32_t>(shell) + 1);
    const float radius = m_field.radius * shellRadius(m_field, shell);
    double squares = 0;
    int points = 0;
    for (int i = 0; i < kErrorPoints; ++i) {
        const vec3 direction = randomDirection(random);
        const Sh4 truth =
            traceVisibility(scene.handle(), m_field.center + radius * direction, directions, basis);
        if (truth.c[0] < kSeesNothing)
            continue;
        ++points;
        const vec2 at = octahedralUv(direction) * static_cast<float>(m_side - 1);
        const std::size_t x = std::min(static_cast<std::size_t>(at.x), m_side - 2);
        const std::size_t y = std::min(static_cast<std::size_t>(at.y), m_side - 2);
        const float fx = at.x - static_cast<float>(x), fy = at.y - static_cast<float>(y);
        Sh4 steps;
        for (std::size_t k = 0; k < kFieldCoefficients; ++k) {
            const auto q = [&](std::size_t dx, std::size_t dy) {
                return static_cast<float>(texel(0, shell, x + dx, y + dy)[k]) - 128.0f;
            };
            steps.c[k] = (1 - fy) * ((1 - fx) * q(0, 0) + fx * q(1, 0)) +
                         fy * ((1 - fx) * q(0, 1) + fx * q(1, 1));
        }
        const Sh4 stored = fieldVisibility(steps, shellStep(m_field, shell));
        for (std::size_t k = 0; k < kFieldCoefficients; ++k)
            squares += std::pow(static_cast<double>(stored.c[k]) - truth.c[k], 2);
    }
    return points == 0 ? -1.0f
                       : static_cast<float>(std::sqrt(squares / (4 * std::numbers::pi * points)));
}

std::vector<std::size_t> shellsToShow(const ShadowField& field, std::size_t count)
{
    const std::size_t last = field.shellSides.size() - 1;
    std::vector<std::size_t> shown;
    for (std::size_t i = 0; i < count; ++i)
        if (const std::size_t shell = (i * last + (count - 1) / 2) / (count - 1);
            shown.empty() || shown.back() != shell)
            shown.push_back(shell);
    const auto leftOut = [&](std::size_t shell) { return field.shellSides[shell] == 0; };
    if (shown.size() < 3 || std::any_of(shown.begin(), shown.end(), leftOut))
        return shown;
    // The nearest one in the place of an inner one.
    for (std::size_t distance = 1; distance < last; ++distance)
        for (std::size_t i = 1; i + 1 < shown.size(); ++i)
            for (const std::size_t shell : {shown[i] + distance, shown[i] - distance})
                if (shell > shown[i - 1] && shell < shown[i + 1] && leftOut(shell)) {
                    shown[i] = shell;
                    return shown;
                }
    return shown;
}

} // namespace penumbra
