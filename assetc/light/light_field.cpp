#include "assetc/light/light_field.h"

#include "shaders/shared/field.h"

#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>

namespace penumbra {

namespace {

// Weaker than any light; keeps 1 / scale finite.
constexpr float kMinBandScale = 1e-30f;

std::size_t bandOf(std::size_t coefficient)
{
    return coefficient < 1 ? 0 : coefficient < 4 ? 1 : coefficient < 9 ? 2 : 3;
}

// Coefficients over g(r), [shell][y][x].
std::vector<RadianceSh> sampleEmitter(const Emitter& emitter, const ShadowField& field,
                                      Progress& progress)
{
    const std::size_t side = field.shellSides[0], shells = field.shellSides.size();
    std::vector<RadianceSh> samples(shells * side * side);
    const auto last = static_cast<float>(side - 1);
    progress.begin("light", shells * side);
    tbb::parallel_for(std::size_t{0}, shells * side, [&](std::size_t row) {
        const float r = shellRadius(field, row / side);
        const float inverseDecay = 1 / fieldDecay(r * r);
        for (std::size_t x = 0; x < side; ++x) {
            const vec2 uv = vec2(static_cast<float>(x), static_cast<float>(row % side)) / last;
            RadianceSh& sample = samples[row * side + x];
            sample = emitter.radianceAt(field.center + field.radius * r * octahedralDirection(uv));
            for (Sh4& sh : sample)
                for (float& c : sh.c)
                    c *= inverseDecay;
        }
        progress.step();
    });
    return samples;
}

} // namespace

ShadowField bakeLightField(const Emitter& emitter, const LightFieldOptions& options,
                           Progress& progress)
{
    PENUMBRA_ASSERT(options.shells >= 2 && options.side >= 3, "{} shells of side {}",
                    options.shells, options.side);
    const Sphere bounds = emitter.bounds();
    ShadowField field;
    field.kind = FieldKind::Radiance;
    field.channels = 3;
    field.center = bounds.center;
    field.radius = bounds.radius;
    field.innerRadius = options.innerRadius;
    field.outerRadius = options.outerRadius;
    field.shellSides.assign(options.shells, static_cast<std::uint16_t>(options.side));
    const std::vector<RadianceSh> samples = sampleEmitter(emitter, field, progress);

    std::array<float, 4> largest{};
    for (const RadianceSh& sample : samples)
        for (const Sh4& sh : sample)
            for (std::size_t k = 0; k < 16; ++k)
                largest[bandOf(k)] = std::max(largest[bandOf(k)], std::abs(sh.c[k]));
    std::array<float, 4> steps{};
    for (std::size_t l = 0; l < 4; ++l)
        if (largest[l] / 127 > kMinBandScale) {
            field.bandScale[l] = largest[l] / 127;
            steps[l] = 1 / field.bandScale[l];
        }
    field.texels.reserve(fieldTexelBytes(field));
    for (std::size_t channel = 0; channel < 3; ++channel)
        for (const RadianceSh& sample : samples)
            for (std::size_t k = 0; k < 16; ++k)
                field.texels.push_back(static_cast<std::uint8_t>(std::clamp(
                    std::lround(sample[channel].c[k] * steps[bandOf(k)]) + 128L, 1L, 255L)));
    return field;
}

AdaptReport adaptLightShells(ShadowField& field, float threshold)
{
    int most = 0; // largest mean radiance, in steps of band 0
    for (std::size_t i = 0; i < field.texels.size(); i += kFieldCoefficients)
        most = std::max(most, field.texels[i] - 128);
    const float mean = static_cast<float>(most) * field.bandScale[0] / kSqrt4Pi;
    if (!(mean > kMinBandScale))
        return {field.texels.size(), field.texels.size(), 0};

    // The same bytes with steps of the relative error on all shells: all of them at one radius.
    ShadowField relative = field;
    relative.innerRadius = 1;
    relative.outerRadius = 1;
    for (float& scale : relative.bandScale)
        scale /= mean * fieldDecay(1);
    const AdaptReport report = adaptShells(relative, threshold);
    field.shellSides = std::move(relative.shellSides);
    field.texels = std::move(relative.texels);
    return report;
}

} // namespace penumbra
