#include "assetc/light/light_field.h"

#include "shaders/shared/field.h"

#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>

namespace penumbra {

namespace {

// Coefficients, [channel][shell][y][x].
std::vector<Sh4> sampleEmitter(const Emitter& emitter, const ShadowField& field, Progress& progress)
{
    const std::size_t side = field.shellSides[0], shells = field.shellSides.size();
    const std::size_t perChannel = shells * side * side;
    std::vector<Sh4> samples(3 * perChannel);
    const auto last = static_cast<float>(side - 1);
    progress.begin("light", shells * side);
    tbb::parallel_for(std::size_t{0}, shells * side, [&](std::size_t row) {
        const float r = shellRadius(field, row / side);
        for (std::size_t x = 0; x < side; ++x) {
            const vec2 uv = vec2(static_cast<float>(x), static_cast<float>(row % side)) / last;
            const RadianceSh radiance =
                emitter.radianceAt(field.center + field.radius * r * octahedralDirection(uv));
            for (std::size_t channel = 0; channel < 3; ++channel)
                samples[channel * perChannel + row * side + x] = radiance[channel];
        }
        progress.step();
    });
    return samples;
}

} // namespace

FieldSamples bakeLightField(const Emitter& emitter, const LightFieldOptions& options,
                            Progress& progress)
{
    PENUMBRA_ASSERT(options.shells >= 2 && options.side >= 3, "{} shells of side {}",
                    options.shells, options.side);
    const Sphere bounds = emitter.bounds();
    FieldSamples samples;
    ShadowField& field = samples.head;
    field.kind = FieldKind::Radiance;
    field.channels = 3;
    field.center = bounds.center;
    field.radius = bounds.radius;
    field.innerRadius = options.innerRadius;
    field.outerRadius = options.outerRadius;
    field.shellSides.assign(options.shells, static_cast<std::uint16_t>(options.side));
    samples.nodes = sampleEmitter(emitter, field, progress);
    return samples;
}

float brightestRadiance(const FieldSamples& field)
{
    const std::size_t shells = field.head.shellSides.size();
    float largest = 0;
    for (std::size_t grid = 0; grid < 3 * shells; ++grid) {
        const float r = shellRadius(field.head, grid % shells);
        const std::size_t first = firstNode(field.head, grid);
        const std::size_t side = field.head.shellSides[grid % shells];
        for (std::size_t i = first; i < first + side * side; ++i)
            largest = std::max(largest, field.nodes[i].c[0] / (kSqrt4Pi * fieldDecay(r * r)));
    }
    return largest;
}

std::vector<Probe> probeLight(const Emitter& emitter, const ShadowField& field)
{
    // Every second of them: a light, unlike an object, is dark inside but nowhere without a truth.
    constexpr std::size_t kStep = 2;
    const ProbePoints drawn = drawProbes(field);
    std::vector<Probe> probes((drawn.probes.size() + kStep - 1) / kStep * 3);
    tbb::parallel_for(std::size_t{0}, probes.size() / 3, [&](std::size_t i) {
        const auto place = [&](std::size_t point) { // 0: the probe, 1 and 2: on its shells
            const PointSet& points = drawn.points.points;
            const std::size_t p = 3 * kStep * i + point;
            return field.center + field.radius * vec3(points.x[p], points.y[p], points.z[p]);
        };
        const auto [exact, noise] = emitter.estimateAt(place(0));
        const RadianceSh low = emitter.radianceAt(place(1)), high = emitter.radianceAt(place(2));
        for (std::size_t c = 0; c < 3; ++c) {
            const Probe& at = drawn.probes[kStep * i];
            probes[3 * i + c] = {at.direction, at.shell, exact[c], low[c], high[c], noise[c]};
        }
    });
    return probes;
}

} // namespace penumbra
