#include "demo/reference/sampling.h"

#include <algorithm>
#include <numbers>

namespace penumbra {

namespace {

constexpr float kPi = std::numbers::pi_v<float>;

std::uint64_t mortonCode(glm::uvec2 p)
{
    std::uint64_t code = 0;
    for (int bit = 31; bit >= 0; --bit)
        code = code << 2 | (p.y >> bit & 1u) << 1 | (p.x >> bit & 1u);
    return code;
}

float power(float base, float exponent)
{
    return exponent == 0.0f ? 1.0f : std::pow(base, exponent);
}

} // namespace

std::vector<glm::uvec2> makeSamplePoints(std::uint32_t count)
{
    PENUMBRA_ASSERT(count >= 1 && (count & (count - 1)) == 0, "{} points, not a power of two",
                    count);
    std::vector<glm::uvec2> points(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        std::uint32_t x = 0, y = 0;
        for (std::uint32_t bits = i, vx = 1u << 31, vy = 1u << 31; bits != 0;
             bits >>= 1, vx >>= 1, vy ^= vy >> 1) {
            x ^= (bits & 1u) * vx;
            y ^= (bits & 1u) * vy;
        }
        points[i] = {x, y};
    }
    std::sort(points.begin(), points.end(),
              [](glm::uvec2 a, glm::uvec2 b) { return mortonCode(a) < mortonCode(b); });
    return points;
}

Frame::Frame(vec3 n) : z(n)
{
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    const float b = n.x * n.y * a;
    x = {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x};
    y = {b, sign + n.y * n.y * a, -n.y};
}

Reflectance::Reflectance(vec3 normal, vec3 toEye, const MeshMaterial& material)
    : m_normal(normal), m_mirror(normalize(2.0f * dot(normal, toEye) * normal - toEye)),
      m_gloss(material.glossFraction), m_exponent(material.glossExponent)
{}

Reflectance::Value Reflectance::evaluate(vec3 direction) const
{
    const float cosine = dot(m_normal.z, direction);
    if (cosine <= 0.0f)
        return {0.0f, 0.0f};
    Value value{(1.0f - m_gloss) * cosine / kPi, (1.0f - m_gloss) * cosine / kPi};
    const float mirrored = m_gloss > 0.0f ? dot(m_mirror.z, direction) : 0.0f;
    if (mirrored > 0.0f) {
        const float lobe = m_gloss * power(mirrored, m_exponent) / (2.0f * kPi);
        value.f += lobe * (m_exponent + 2.0f) * cosine;
        value.pdf += lobe * (m_exponent + 1.0f);
    }
    return value;
}

vec3 Reflectance::sample(vec2 u) const
{
    const bool glossy = u.x < m_gloss;
    const float stretched = glossy ? u.x / m_gloss : (u.x - m_gloss) / (1.0f - m_gloss);
    const float phi = 2.0f * kPi * u.y;
    const float z = glossy ? power(stretched, 1.0f / (m_exponent + 1.0f)) : sqrt(stretched);
    const float radius = sqrt(max(0.0f, 1.0f - z * z));
    const Frame& frame = glossy ? m_mirror : m_normal;
    return frame.toWorld({radius * cos(phi), radius * sin(phi), z});
}

} // namespace penumbra
