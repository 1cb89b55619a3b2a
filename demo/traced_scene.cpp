#include "demo/traced_scene.h"

#include "shaders/shared/pixel.h"

namespace penumbra {

mat4 worldFromObject(const GpuInstance& g)
{
    return glm::transpose(
        mat4(g.worldFromObject0, g.worldFromObject1, g.worldFromObject2, vec4(0, 0, 0, 1)));
}

namespace {

ReferenceReceiver referenceReceiver(const GpuInstance& g, std::uint32_t instance, uvec4 geometry,
                                    vec3 eye)
{
    const Receiver shaded = makeReceiver(g, geometry, eye);
    ReferenceReceiver r;
    r.position = shaded.position;
    r.normal = normalize(shaded.normal);
    r.toEye = normalize(eye - r.position);
    r.material = r.instance = instance;
    return r;
}

} // namespace

Result<TracedScene> traceable(const SceneData& data, const CpuInstances& rows,
                              std::span<const MeshAsset* const> meshes)
{
    std::vector<ReferenceInstance> instances;
    std::vector<MeshMaterial> materials;
    for (std::uint32_t i = 0; i < data.instances.size(); ++i) {
        instances.push_back(
            {meshes[data.instances[i].mesh], worldFromObject(rows.instances[i]), i});
        materials.push_back(receiverMaterial(data, data.instances[i]));
    }
    std::vector<AreaLight> lights;
    for (std::size_t l = 0; l < data.lights.size(); ++l) {
        const SceneLight& light = data.lights[l];
        std::uint32_t surface = light.owner.value_or(static_cast<std::uint32_t>(instances.size()));
        if (surface == instances.size()) {
            instances.push_back({meshes[light.asset],
                                 worldFromObject(rows.instances[data.instances.size() + l]),
                                 surface});
            materials.emplace_back();
        }
        Result<AreaLight> area = AreaLight::make(surface, instances[surface], light.intensity);
        if (!area)
            return area.error();
        lights.push_back(std::move(*area));
    }
    Result<ReferenceScene> scene = ReferenceScene::build(instances, materials);
    if (!scene)
        return scene.error();
    return TracedScene{std::move(*scene), std::move(lights)};
}

Receivers visibleReceivers(const SceneData& data, const CpuInstances& rows,
                           const FrameConstants& constants)
{
    Receivers out;
    for (const ClusterEntities& visible : cullAndSort(data, rows, constants)) {
        const SceneCluster& cluster = data.clusters[visible.cluster];
        const MeshRange& mesh = data.meshes[data.instances[cluster.instance].mesh];
        if (data.instances[cluster.instance].emission * mesh.emission != vec3(0))
            continue;
        const GpuInstance& g = rows.instances[cluster.instance];
        for (std::uint32_t v = 0; v < kClusterReceivers; ++v) {
            if (cluster.firstReceiver + v >= mesh.firstReceiver + mesh.vertexCount)
                break; // padding
            out.receivers.push_back(referenceReceiver(
                g, cluster.instance, data.receivers[cluster.firstReceiver + v].geometry,
                vec3(constants.eye)));
            out.radianceIndex.push_back(cluster.firstRadiance + v);
        }
    }
    return out;
}

Receivers pixelReceivers(const SceneData& data, const CpuInstances& rows,
                         const FrameConstants& constants, const GbufferPixels& pixels)
{
    Receivers out;
    for (std::size_t i = 0; i < pixels.instances.size(); ++i) {
        const std::uint32_t instance = pixels.instances[i];
        if (instance == kBackground)
            continue;
        const SceneInstance& shown = data.instances[instance];
        if (shown.emission * data.meshes[shown.mesh].emission != vec3(0))
            continue;
        out.receivers.push_back(referenceReceiver(
            rows.instances[instance], instance, pixels.receivers[i].geometry, vec3(constants.eye)));
        out.radianceIndex.push_back(static_cast<std::uint32_t>(i));
    }
    return out;
}

std::vector<vec3> atReceivers(std::span<const vec4> radiance, const Receivers& receivers)
{
    std::vector<vec3> values;
    for (const std::uint32_t index : receivers.radianceIndex)
        values.push_back(vec3(radiance[index]));
    return values;
}

} // namespace penumbra
