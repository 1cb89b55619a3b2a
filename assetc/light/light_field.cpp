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

// Mean radiance of the brightest place over g(r), in the strongest channel.
float brightest(const FieldSamples& field)
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

AdaptReport adaptLightShells(FieldSamples& field, float threshold)
{
    return adaptShells(field, {threshold, brightest(field)});
}

} // namespace penumbra
