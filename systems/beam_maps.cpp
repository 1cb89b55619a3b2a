#include "systems/beam_maps.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

namespace {

struct Sphere {
    vec3 center; // world, metres
    float radius;
};

std::vector<Sphere> casterSpheres(const SceneData& scene)
{
    std::vector<Sphere> spheres;
    for (const SceneInstance& instance : scene.instances) {
        if (!instance.occluder)
            continue;
        const FieldInput& field = scene.fields[scene.meshes[*instance.occluder].field];
        spheres.push_back(
            {instance.position + instance.scale * rotate(instance.rotation, field.center),
             instance.scale * field.radius});
    }
    return spheres;
}

// Of all spheres along an axis.
struct Extent {
    float low = 0, high = 0;
};

Extent extentAlong(std::span<const Sphere> spheres, vec3 axis)
{
    Extent extent{1e30f, -1e30f};
    for (const Sphere& sphere : spheres) {
        const float at = dot(axis, sphere.center);
        extent.low = std::min(extent.low, at - sphere.radius);
        extent.high = std::max(extent.high, at + sphere.radius);
    }
    return extent;
}

// How far the level that casts leaves the mesh that receives, metres.
float largestCasterError(const SceneData& scene)
{
    float largest = 0;
    for (const SceneInstance& instance : scene.instances)
        if (instance.occluder)
            largest =
                std::max(largest, instance.scale * scene.meshes[*instance.occluder].casterError);
    return largest;
}

// How much of a beam's disc its penumbra is made of: the beams beside it blur as well, and a mean
// distance of what blocks says too much where the disc is wide (docs/decisions/0015).
constexpr float kDiscShare = 0.5f;

// Of a texel: how far receivers are lifted off their own surface in the map. Less makes acne, more
// loses contacts (likewise).
constexpr float kLift = 0.5f;

constexpr float kTexel = 1.0f / static_cast<float>(kBeamMapSide);

// Where a map lies along an axis: an empty texel on each side, and another for the step to whole
// ones. Four sizes per octave.
Extent windowAlong(std::span<const Sphere> casters, vec3 axis)
{
    const Extent along = extentAlong(casters, axis);
    const float least = (along.high - along.low) / (1 - 4 * kTexel);
    const float side = std::exp2(std::ceil(4 * std::log2(least)) / 4);
    const float texel = side * kTexel;
    const float low = texel * std::floor((0.5f * (along.low + along.high - side)) / texel);
    return {low, low + side};
}

// 0 at the low end of the window, 1 at the high end.
vec4 mapRow(vec3 axis, Extent window)
{
    return vec4(axis, -window.low) / (window.high - window.low);
}

GpuBeam placeBeam(const SkyBeam& beam, std::span<const Sphere> casters, float casterError)
{
    const vec3 d = beam.direction;
    const vec3 u = normalize(cross(std::abs(d.y) < 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0), d));
    const vec3 v = cross(d, u);
    const Extent alongU = windowAlong(casters, u), alongV = windowAlong(casters, v);
    const Extent height = extentAlong(casters, d);
    const float range = height.high - height.low;
    const vec2 size(alongU.high - alongU.low, alongV.high - alongV.low);
    const float texel = std::max(size.x, size.y) * kTexel;
    GpuBeam out{};
    out.u = mapRow(u, alongU);
    out.v = mapRow(v, alongV);
    out.depth = vec4(-d, height.high) / range;
    out.direction = vec4(d, kDiscShare * std::tan(beam.halfAngle));
    out.irradiance = vec4(beam.irradiance, range);
    out.size = vec4(size, casterError + kLift * texel, std::tan(beam.halfAngle));
    return out;
}

} // namespace

Result<Image> createBeamMaps(const Device& device, std::uint32_t count)
{
    const std::uint32_t rows = (count + kBeamMapColumns - 1) / kBeamMapColumns;
    const std::uint32_t columns = std::min(count, kBeamMapColumns);
    return createImage(
        device,
        {.name = "beam maps",
         .extent = {std::max(columns * kBeamMapSide, 1u), std::max(rows * kBeamMapSide, 1u)},
         .format = kBeamMapFormat,
         .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT});
}

void placeBeams(const SceneData& scene, std::span<const SkyBeam> beams, FrameConstants& frame)
{
    PENUMBRA_ASSERT(beams.size() <= kMaxBeams, "{} beams, at most {}", beams.size(), kMaxBeams);
    frame.beamCount = static_cast<std::uint32_t>(beams.size());
    if (beams.empty())
        return;
    std::vector<Sphere> casters = casterSpheres(scene);
    if (casters.empty())
        casters.push_back({vec3(0), 1}); // empty maps
    const float error = largestCasterError(scene);
    for (std::size_t k = 0; k < beams.size(); ++k)
        frame.beams[k] = placeBeam(beams[k], casters, error);
}

std::vector<CasterRun> casterRuns(const SceneData& scene)
{
    std::vector<CasterRun> runs;
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
        const SceneInstance& instance = scene.instances[i];
        if (!instance.occluder)
            continue;
        if (!runs.empty() && runs.back().mesh == *instance.occluder &&
            runs.back().firstInstance + runs.back().instanceCount == i)
            ++runs.back().instanceCount;
        else
            runs.push_back({*instance.occluder, i, 1});
    }
    return runs;
}

VkRect2D beamMapArea(std::uint32_t index)
{
    return {{static_cast<std::int32_t>(index % kBeamMapColumns * kBeamMapSide),
             static_cast<std::int32_t>(index / kBeamMapColumns * kBeamMapSide)},
            {kBeamMapSide, kBeamMapSide}};
}

} // namespace penumbra
