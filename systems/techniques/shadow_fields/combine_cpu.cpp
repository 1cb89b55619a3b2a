#include "systems/techniques/shadow_fields/combine_cpu.h"

#include "shaders/shared/visibility.h"

#include <algorithm>

namespace penumbra {

namespace {

struct ClusterSphere {
    vec3 center; // world
    float radius;
    vec3 faceAxis, vertexAxis;
};

ClusterSphere worldBounds(const ClusterBounds& bounds, const GpuInstance& g)
{
    ClusterSphere s;
    s.center =
        affine(g.worldFromObject0, g.worldFromObject1, g.worldFromObject2, vec3(bounds.sphere));
    const auto axis = [&](vec3 object) {
        return linear(g.worldFromObject0, g.worldFromObject1, g.worldFromObject2, object) /
               g.material1.y;
    };
    s.faceAxis = axis(vec3(bounds.faces));
    s.vertexAxis = axis(vec3(bounds.vertices));
    s.radius = bounds.sphere.w * g.material1.y;
    return s;
}

Sh4 sampleTrilinear(const std::vector<uvec4>& samples, const FieldEntity& entity, const vec3& p)
{
    const FieldCell cell = fieldCell(p, entity.grid);
    Sh4 sum{};
    for (uint corner = 0; corner < 8; ++corner) {
        const Sh4 steps =
            fieldSteps(samples[cell.sample0 + fieldCornerOffset(corner, entity.grid)]);
        const float weight = fieldCornerWeight(corner, cell.fraction);
        for (int k = 0; k < 16; ++k)
            sum.c[k] += weight * steps.c[k];
    }
    return fieldVisibility(sum, entity.bandScale * cell.decay);
}

Sh4 sampleTetrahedral(const std::vector<uvec4>& samples, const FieldEntity& entity, const vec3& p)
{
    const FieldCell cell = fieldCell(p, entity.grid);
    const FieldTetrahedron t = fieldTetrahedron(cell.fraction, entity.grid);
    const Sh4 steps = fieldBlend(samples[cell.sample0], samples[cell.sample0 + t.offset.y],
                                 samples[cell.sample0 + t.offset.z],
                                 samples[cell.sample0 + t.offset.w], t.weight);
    return fieldVisibility(steps, entity.bandScale * (cell.decay * (1.0f / 256.0f)));
}

} // namespace

CpuInstances updateInstances(const SceneData& scene)
{
    CpuInstances out;
    for (const SceneInstance& instance : scene.instances) {
        const InstanceInput input = instanceInput(scene, instance);
        out.instances.push_back(
            makeInstance(input, scene.fields[input.field == kNoField ? 0 : input.field]));
        out.dense.push_back(denseRotation(instanceRotation(out.instances.back())));
    }
    return out;
}

std::vector<ClusterOccluders> cullAndSort(const SceneData& scene, const CpuInstances& instances,
                                          const FrameConstants& frame)
{
    std::vector<ClusterOccluders> visible;
    std::vector<std::pair<float, std::uint32_t>> near;
    for (std::uint32_t c = 0; c < scene.clusters.size(); ++c) {
        const SceneCluster& cluster = scene.clusters[c];
        const ClusterBounds& bounds = scene.bounds[cluster.bounds];
        const ClusterSphere s = worldBounds(bounds, instances.instances[cluster.instance]);
        const bool outside =
            std::any_of(std::begin(frame.frustum), std::end(frame.frustum), [&](const vec4& plane) {
                return sphereOutside(plane, s.center, s.radius);
            });
        if (outside || facesAway(s.center - vec3(frame.eye), s.faceAxis, bounds.faces.w, s.radius))
            continue;

        near.clear();
        for (std::uint32_t i = 0; i < instances.instances.size(); ++i) {
            const GpuInstance& g = instances.instances[i];
            const vec3 to = vec3(g.sphere) - s.center;
            const float distance = length(to), influence = g.grid.w;
            if (i == cluster.instance || influence == 0 || distance - s.radius > influence ||
                belowHorizon(to, g.sphere.w, s.vertexAxis, bounds.vertices.w, s.radius))
                continue;
            near.emplace_back(distance, i);
        }
        std::sort(near.begin(), near.end());
        near.resize(std::min<std::size_t>(near.size(), kMaxClusterOccluders));
        visible.push_back({c, {}});
        for (const auto& [distance, instance] : near)
            visible.back().occluders.push_back(instance);
    }
    return visible;
}

void combineCluster(Kernel kernel, const SceneData& scene, const CpuInstances& instances,
                    const FrameConstants& frame, const ClusterOccluders& visible,
                    std::span<vec4> radiance)
{
    const SceneCluster& cluster = scene.clusters[visible.cluster];
    const GpuInstance& self = instances.instances[cluster.instance];
    const ShRotation worldFromObject = instanceRotation(self);
    for (std::uint32_t v = 0; v < kClusterReceivers; ++v) {
        const ReceiverTexels& texels = scene.receivers[cluster.firstReceiver + v];
        const Receiver receiver = makeReceiver(self, texels.geometry, vec3(frame.eye));
        const Sh4 ownVisibility = selfVisibility(texels.selfVisibility, kSelfVisibilityScale);
        vec3 sum(0);
        if (kernel == Kernel::Literal) {
            Sh4 transfer = transferSh(
                shRotateDense(ownVisibility, instances.dense[cluster.instance]), receiver);
            for (const std::uint32_t occluder : visible.occluders) {
                const FieldEntity entity = instanceField(instances.instances[occluder]);
                const vec3 p = fieldPoint(entity, receiver.position);
                const Sh4 visibility = sampleTrilinear(scene.fieldSamples, entity, p);
                transfer =
                    shProduct(shRotateDense(visibility, instances.dense[occluder]), transfer);
            }
            for (int k = 0; k < 16; ++k)
                sum += transfer.c[k] * vec3(frame.light[k]);
        } else {
            ShNodal transfer = transferNodal(shRotate(ownVisibility, worldFromObject), receiver);
            for (const std::uint32_t occluder : visible.occluders) {
                const FieldEntity entity = instanceField(instances.instances[occluder]);
                const vec3 p = fieldPoint(entity, receiver.position);
                const Sh4 visibility = sampleTetrahedral(scene.fieldSamples, entity, p);
                transfer = shMultiply(transfer, shNodes(shRotate(visibility, entity.rotation)));
            }
            for (int n = 0; n < 32; ++n)
                sum += transfer.v[n] * vec3(frame.lightNodes[n]);
        }
        radiance[cluster.firstRadiance + v] = vec4(vec3(self.material) * sum, 1);
    }
}

} // namespace penumbra
