#include "assetc/field_errors.h"

#include "runtime/assert.h"
#include "shaders/shared/field.h"

#include <algorithm>
#include <glm/gtc/constants.hpp>

namespace penumbra {

namespace {

// A field as the GPU holds it: one side on all shells, [y][x][shell], coefficients over g(r).
class UniformField {
public:
    UniformField(const ShadowField& head, std::uint32_t side)
        : m_grid{0, side, 0, 0, 0, static_cast<std::uint32_t>(head.shellSides.size())},
          m_nodes(std::size_t{side} * side * m_grid.shells)
    {
        const float last = static_cast<float>(m_grid.shells - 1);
        m_grid.lastShell = last;
        m_grid.shellScale = last / std::log2(head.outerRadius / head.innerRadius);
        m_grid.shellBias = -m_grid.shellScale * std::log2(head.innerRadius);
    }

    Sh4& at(std::size_t shell, std::size_t node) { return m_nodes[node * m_grid.shells + shell]; }

    // Trilinear; `p` in bounding radii. `fade`: to 0 over the last interval, as readers do.
    [[nodiscard]] Sh4 sample(vec3 p, bool fade) const
    {
        const FieldCell cell = fieldCell(p, m_grid);
        const float decay = fade ? cell.decay : fieldDecay(dot(p, p));
        Sh4 sum{};
        for (uint corner = 0; corner < 8; ++corner) {
            const Sh4& node = m_nodes[cell.sample0 + fieldCornerOffset(corner, m_grid)];
            const float weight = fieldCornerWeight(corner, cell.fraction) * decay;
            for (int k = 0; k < 16; ++k)
                sum.c[k] += weight * node.c[k];
        }
        return sum;
    }

private:
    FieldGrid m_grid;
    std::vector<Sh4> m_nodes;
};

// `grid`: frame * channels + channel.
UniformField readBytes(const ShadowField& field, std::size_t grid)
{
    const std::uint32_t side = largestSide(field);
    UniformField out(field, side);
    const std::vector<std::uint8_t> texels = refineField(field, grid);
    const std::size_t nodes = std::size_t{side} * side;
    const vec4 scale(field.bandScale[0], field.bandScale[1], field.bandScale[2],
                     field.bandScale[3]);
    for (std::size_t s = 0; s < field.shellSides.size(); ++s)
        for (std::size_t n = 0; n < nodes; ++n) {
            Sh4 steps;
            for (std::size_t k = 0; k < 16; ++k)
                steps.c[k] = static_cast<float>(texels[(s * nodes + n) * 16 + k]) - 128.0f;
            out.at(s, n) = fieldDeviation(steps, scale);
        }
    return out;
}

UniformField readSamples(const FieldSamples& samples, std::size_t grid)
{
    const std::uint32_t side = largestSide(samples.head);
    UniformField out(samples.head, side);
    const std::vector<Sh4> nodes = refineNodes(samples, grid, side);
    const std::size_t perShell = std::size_t{side} * side;
    for (std::size_t s = 0; s < samples.head.shellSides.size(); ++s)
        for (std::size_t n = 0; n < perShell; ++n)
            out.at(s, n) = nodes[s * perShell + n];
    return out;
}

// double: the square of a faint light's radiance is no float.
double squared(const Sh4& a)
{
    double sum = 0;
    for (const double c : a.c)
        sum += c * c;
    return sum;
}

Sh4 difference(const Sh4& a, const Sh4& b)
{
    Sh4 d;
    for (int k = 0; k < 16; ++k)
        d.c[k] = a.c[k] - b.c[k];
    return d;
}

// Root mean square and maximum of what is added, as squares over the whole sphere.
class Collector {
public:
    void add(double square)
    {
        const double mean = std::max(0.0, square) / (4 * glm::pi<double>());
        m_sum += mean;
        m_largest = std::max(m_largest, mean);
        ++m_count;
    }
    [[nodiscard]] FieldError result() const
    {
        return {static_cast<float>(std::sqrt(m_sum / static_cast<double>(std::max(m_count, 1u)))),
                static_cast<float>(std::sqrt(m_largest))};
    }

private:
    double m_sum = 0, m_largest = 0;
    std::uint32_t m_count = 0;
};

// One frame and channel: squared differences at a probe, by cause.
class Channel {
public:
    Channel(const FieldSamples& samples, const ShadowField& field, std::size_t grid)
        : m_field(field), m_bytes(readBytes(field, grid)), m_floats(readSamples(samples, grid))
    {}

    struct Squares {
        double total, angular, radial, quantisation, directions;
        double decay, lowDecay; // g(r) at the probe and on the shell below it
    };
    // `fade`: the exact field does not end, so what readers fade out counts in `total`.
    [[nodiscard]] Squares at(const Probe& probe, bool fade) const
    {
        const float lowShell = std::floor(probe.shell), t = probe.shell - lowShell;
        const float low = shellRadius(m_field, static_cast<std::size_t>(lowShell));
        const float high = shellRadius(m_field, static_cast<std::size_t>(lowShell) + 1);
        const float r = low * std::pow(high / low, t);
        const vec3 place = probe.direction * r;
        const Sh4 floats = m_floats.sample(place, false);
        Sh4 between; // linear in the coefficients over g(r), as readers interpolate
        for (int k = 0; k < 16; ++k)
            between.c[k] = ((1 - t) * probe.low.c[k] / fieldDecay(low * low) +
                            t * probe.high.c[k] / fieldDecay(high * high)) *
                           fieldDecay(r * r);
        return {squared(difference(m_bytes.sample(place, fade), probe.exact)),
                squared(difference(m_floats.sample(probe.direction * low, false), probe.low)),
                squared(difference(between, probe.exact)),
                squared(difference(m_bytes.sample(place, false), floats)),
                squared(probe.noise),
                fieldDecay(r * r),
                fieldDecay(low * low)};
    }

private:
    const ShadowField& m_field;
    UniformField m_bytes, m_floats;
};

struct Causes {
    Collector total, angular, radial, quantisation, directions, bandLimit;

    [[nodiscard]] FieldErrors result(std::uint32_t points) const
    {
        return {points,
                total.result(),
                angular.result(),
                radial.result(),
                quantisation.result(),
                directions.result(),
                bandLimit.result()};
    }
};

} // namespace

FieldErrors measureErrors(const FieldSamples& samples, const ShadowField& field,
                          const std::vector<Probe>& probes)
{
    const Channel channel(samples, field, 0);
    Causes causes;
    std::uint32_t points = 0;
    for (const Probe& probe : probes) {
        if (std::min({probe.exact.c[0], probe.low.c[0], probe.high.c[0]}) < kSeesNothing)
            continue;
        ++points;
        const Channel::Squares squares = channel.at(probe, true);
        causes.total.add(squares.total);
        causes.quantisation.add(squares.quantisation);
        causes.angular.add(squares.angular);
        causes.radial.add(squares.radial);
        causes.directions.add(squares.directions);
        causes.bandLimit.add(-probe.exact.c[0] * kSqrt4Pi - squared(probe.exact));
    }
    return causes.result(points);
}

FieldErrors measureRadianceErrors(const FieldSamples& samples, const ShadowField& field,
                                  const std::vector<Probe>& probes, float radiance)
{
    const std::size_t channels = field.channels;
    PENUMBRA_ASSERT(field.frames == 1 && probes.size() % channels == 0 && radiance > 0,
                    "{} probes of {} channels, {} frames, radiance {}", probes.size(), channels,
                    field.frames, radiance);
    std::vector<Channel> grids;
    for (std::size_t c = 0; c < channels; ++c)
        grids.emplace_back(samples, field, c);
    Causes causes;
    const double unit = radiance;
    const double part = 1 / (unit * unit * static_cast<double>(channels));
    for (std::size_t i = 0; i < probes.size(); i += channels) {
        Channel::Squares sum{};
        for (std::size_t c = 0; c < channels; ++c) {
            const Channel::Squares squares = grids[c].at(probes[i + c], false);
            const double here = part / (squares.decay * squares.decay);
            sum.total += squares.total * here;
            sum.quantisation += squares.quantisation * here;
            sum.angular += squares.angular * (part / (squares.lowDecay * squares.lowDecay));
            sum.radial += squares.radial * here;
            sum.directions += squares.directions * here;
        }
        causes.total.add(sum.total);
        causes.quantisation.add(sum.quantisation);
        causes.angular.add(sum.angular);
        causes.radial.add(sum.radial);
        causes.directions.add(sum.directions);
    }
    return causes.result(static_cast<std::uint32_t>(probes.size() / channels));
}

} // namespace penumbra
