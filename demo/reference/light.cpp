#include "demo/reference/light.h"

#include "shaders/shared/environment.h"
#include "shaders/shared/sh.h"

#include <algorithm>
#include <numbers>

namespace penumbra {

namespace {

// SH of order 4 change little over 2.8 degrees; the map only guides the samples.
constexpr std::uint32_t kSh4Width = 128, kSh4Height = 64;

struct Pick {
    std::uint32_t index;
    float fraction; // where in the interval
};

// The interval of the cumulative `start` [n + 1] that holds u.
Pick pick(const float* start, std::uint32_t n, float u)
{
    const float* above = std::upper_bound(start + 1, start + n, u);
    const auto index = static_cast<std::uint32_t>(above - start - 1);
    const float width = start[index + 1] - start[index];
    return {index, width > 0.0f ? std::min((u - start[index]) / width, 1.0f) : 0.5f};
}

// Cumulative and normalised to 1; evenly where all weights are 0.
void accumulate(std::span<const double> weights, float* start)
{
    double total = 0.0, sum = 0.0;
    for (const double w : weights)
        total += w;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        start[i] =
            static_cast<float>(total > 0.0 ? sum / total : static_cast<double>(i) / weights.size());
        sum += weights[i];
    }
    start[weights.size()] = 1.0f;
}

} // namespace

ReferenceLight::Part::Part(const mat3& worldFromEnvironment, float intensity)
    : m_worldFromEnvironment(worldFromEnvironment),
      m_environmentFromWorld(glm::transpose(worldFromEnvironment)), m_intensity(intensity)
{
    const mat3 square = worldFromEnvironment * m_environmentFromWorld;
    for (int i = 0; i < 3; ++i)
        PENUMBRA_ASSERT(length(square[i] - mat3(1)[i]) < 1e-4f,
                        "worldFromEnvironment is no rotation");
}

ReferenceLight::Part ReferenceLight::Part::fromMap(const Environment& environment,
                                                   const mat3& rotation, float intensity)
{
    PENUMBRA_ASSERT(!environment.map.empty(), "an environment without a map");
    Part light(rotation, intensity);
    light.m_map = environment.map;
    std::vector<float> density;
    for (const vec3& c : environment.map)
        density.push_back(luminance(c));
    light.buildDistribution(environment.mapWidth, environment.mapHeight, std::move(density));
    return light;
}

ReferenceLight::Part ReferenceLight::Part::fromSh4(const std::array<vec3, 16>& sh4,
                                                   const mat3& rotation, float intensity)
{
    Part light(rotation, intensity);
    light.m_sh4 = sh4;
    std::vector<float> density;
    for (std::uint32_t i = 0; i < kSh4Width * kSh4Height; ++i) {
        const vec2 pixel(i % kSh4Width, i / kSh4Width);
        const vec3 direction = equirectDirection((pixel + 0.5f) / vec2(kSh4Width, kSh4Height));
        density.push_back(luminance(glm::abs(light.sh4Radiance(direction))));
    }
    light.buildDistribution(kSh4Width, kSh4Height, std::move(density));
    return light;
}

void ReferenceLight::Part::buildDistribution(std::uint32_t width, std::uint32_t height,
                                             std::vector<float> density)
{
    m_width = width;
    m_height = height;
    m_rowStart.resize(height + 1);
    m_rowCosine.resize(height + 1);
    m_columnStart.resize(std::size_t{height} * (width + 1));
    std::vector<double> row(width), rows(height);
    double integral = 0.0;
    for (std::uint32_t y = 0; y < height; ++y) {
        std::copy_n(density.begin() + static_cast<std::ptrdiff_t>(std::size_t{y} * width), width,
                    row.begin());
        accumulate(row, &m_columnStart[std::size_t{y} * (width + 1)]);
        for (const double d : row)
            rows[y] += d * equirectPixelSolidAngle(width, height, y);
        integral += rows[y];
        m_rowCosine[y] = static_cast<float>(std::cos(std::numbers::pi * y / height));
    }
    m_rowCosine[height] = -1.0f;
    accumulate(rows, m_rowStart.data());
    if (m_map.empty())
        m_density = std::move(density);
    m_densityScale = integral > 0.0 ? static_cast<float>(1.0 / integral) : 0.0f;
}

vec3 ReferenceLight::Part::sh4Radiance(vec3 environmentDirection) const
{
    const Sh4 basis = shBasis(environmentDirection);
    vec3 radiance(0);
    for (int i = 0; i < 16; ++i)
        radiance += basis.c[i] * m_sh4[i];
    return radiance;
}

double ReferenceLight::Part::power() const
{
    return m_densityScale > 0.0f ? static_cast<double>(m_intensity) / m_densityScale : 0.0;
}

ReferenceLight::Value ReferenceLight::Part::valueAt(vec3 environmentDirection,
                                                    std::size_t pixel) const
{
    if (m_map.empty())
        return {m_intensity * sh4Radiance(environmentDirection), m_density[pixel] * m_densityScale};
    const vec3 radiance = m_map[pixel];
    return {m_intensity * radiance, luminance(radiance) * m_densityScale};
}

ReferenceLight::Value ReferenceLight::Part::evaluate(vec3 direction) const
{
    const vec3 local = m_environmentFromWorld * direction;
    const vec2 uv = equirectUv(local);
    const auto x =
        std::min(static_cast<std::uint32_t>(uv.x * static_cast<float>(m_width)), m_width - 1);
    const auto y =
        std::min(static_cast<std::uint32_t>(uv.y * static_cast<float>(m_height)), m_height - 1);
    return valueAt(local, std::size_t{y} * m_width + x);
}

ReferenceLight::Value ReferenceLight::Part::evaluate(vec3 direction, std::size_t pixel) const
{
    return valueAt(m_environmentFromWorld * direction, pixel);
}

ReferenceLight::Sample ReferenceLight::Part::sample(vec2 u) const
{
    const Pick row = pick(m_rowStart.data(), m_height, u.y);
    const Pick column = pick(&m_columnStart[std::size_t{row.index} * (m_width + 1)], m_width, u.x);
    const std::size_t pixel = std::size_t{row.index} * m_width + column.index;
    // Evenly over the pixel's solid angle: y is linear in it.
    const float y = mix(m_rowCosine[row.index], m_rowCosine[row.index + 1], row.fraction);
    const float radius = sqrt(max(0.0f, 1.0f - y * y));
    const float u01 =
        (static_cast<float>(column.index) + column.fraction) / static_cast<float>(m_width);
    const float azimuth = (2.0f * u01 - 1.0f) * kEnvironmentPi;
    const vec3 local(radius * cos(azimuth), y, radius * sin(azimuth));
    return {m_worldFromEnvironment * local, pixel, 0};
}

void ReferenceLight::add(Part part)
{
    if (part.power() > 0)
        m_parts.push_back(std::move(part));
    std::vector<double> powers;
    for (const Part& p : m_parts)
        powers.push_back(p.power());
    m_partStart.resize(m_parts.size() + 1);
    accumulate(powers, m_partStart.data());
}

ReferenceLight ReferenceLight::fromMap(const Environment& environment,
                                       const mat3& worldFromEnvironment, float intensity)
{
    ReferenceLight light;
    light.add(Part::fromMap(environment, worldFromEnvironment, intensity));
    return light;
}

ReferenceLight ReferenceLight::fromSh4(const std::array<vec3, 16>& sh4,
                                       const mat3& worldFromEnvironment, float intensity)
{
    ReferenceLight light;
    light.add(Part::fromSh4(sh4, worldFromEnvironment, intensity));
    return light;
}

ReferenceLight ReferenceLight::sum(std::span<const ReferenceLight> lights)
{
    ReferenceLight all;
    for (const ReferenceLight& light : lights)
        for (const Part& part : light.m_parts)
            all.add(part);
    return all;
}

// `sample`: of that direction, from one of the parts; null: none.
ReferenceLight::Value ReferenceLight::mixed(vec3 direction, const Sample* sample) const
{
    Value value{vec3(0), 0};
    for (std::size_t i = 0; i < m_parts.size(); ++i) {
        const Value part = sample != nullptr && sample->part == i
                               ? m_parts[i].evaluate(direction, sample->pixel)
                               : m_parts[i].evaluate(direction);
        value.radiance += part.radiance;
        value.pdf += (m_partStart[i + 1] - m_partStart[i]) * part.pdf;
    }
    return value;
}

ReferenceLight::Value ReferenceLight::evaluate(vec3 direction) const
{
    return mixed(direction, nullptr);
}

ReferenceLight::Value ReferenceLight::evaluate(const Sample& sample) const
{
    return mixed(sample.direction, &sample);
}

ReferenceLight::Sample ReferenceLight::sample(vec2 u) const
{
    if (m_parts.size() == 1)
        return m_parts.front().sample(u);
    const Pick part = pick(m_partStart.data(), static_cast<std::uint32_t>(m_parts.size()), u.y);
    Sample sample = m_parts[part.index].sample({u.x, part.fraction});
    sample.part = part.index;
    return sample;
}

} // namespace penumbra
