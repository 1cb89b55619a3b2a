#include "assetc/verify.h"

#include "assetc/bake/directions.h"
#include "assetc/embree_scene.h"
#include "assetc/trace_visibility.h"
#include "shaders/shared/field.h"

#include <random>
#include <tbb/parallel_for.h>

namespace penumbra {

namespace {

// A drawn node: where it lies and what was baked there.
struct Sample {
    vec3 position{0}; // object space, metres
    float radius = 0; // bounding radii
    Sh4 baked{};
};

Sample drawSample(const FieldSamples& field, std::mt19937& random)
{
    const std::size_t shell = random() % field.head.shellSides.size();
    const std::size_t side = field.head.shellSides[shell];
    const std::size_t x = random() % side;
    const std::size_t y = random() % side;
    const std::size_t node = firstNode(field.head, shell) + y * side + x;
    if (field.inside[node])
        return drawSample(field, random);

    Sample sample;
    sample.radius = shellRadius(field.head, shell);
    const vec2 uv =
        vec2(static_cast<float>(x), static_cast<float>(y)) / static_cast<float>(side - 1);
    sample.position =
        field.head.center + field.head.radius * sample.radius * octahedralDirection(uv);
    sample.baked = field.nodes[node];
    sample.baked.c[0] += kSqrt4Pi;
    return sample;
}

} // namespace

VerifyReport verifyBake(const MeshAsset& mesh, const FieldSamples& field,
                        const VerifyOptions& options)
{
    PENUMBRA_ASSERT(field.inside.size() == field.nodes.size() &&
                        std::find(field.inside.begin(), field.inside.end(), false) !=
                            field.inside.end(),
                    "no node to verify of {}", field.nodes.size());
    const std::vector<vec3> directions = bakeDirections(field.head.directions);
    std::vector<Sh4> basis;
    for (const vec3 direction : directions)
        basis.push_back(shBasis(direction));

    std::mt19937 random(options.seed);
    std::vector<Sample> samples;
    for (std::uint32_t i = 0; i < options.samples; ++i)
        samples.push_back(drawSample(field, random));
    const EmbreeScene embree(mesh.positions, mesh.indices);
    std::vector<Sh4> traced(samples.size());
    tbb::parallel_for(std::size_t{0}, samples.size(), [&](std::size_t i) {
        traced[i] = traceVisibility(embree.handle(), samples[i].position, directions, basis);
    });

    VerifyReport report{options.samples, field.head.directions};
    double squares = 0;
    for (std::size_t i = 0; i < samples.size(); ++i)
        for (int k = 0; k < 16; ++k) {
            const float difference = std::abs(samples[i].baked.c[k] - traced[i].c[k]);
            squares += static_cast<double>(difference) * difference;
            if (difference > report.max) {
                report.max = difference;
                report.worstRadius = samples[i].radius;
            }
        }
    report.rms = static_cast<float>(std::sqrt(squares / (16.0 * std::max(options.samples, 1u))));
    return report;
}

} // namespace penumbra
