#include "systems/scene_data.h"

#include <algorithm>
#include <cstring>

namespace penumbra {

namespace {

void appendReceivers(const MeshAsset& mesh, MeshRange& range,
                     std::vector<ReceiverTexels>& receivers)
{
    range.firstReceiver = static_cast<std::uint32_t>(receivers.size());
    range.vertexCount = static_cast<std::uint32_t>(mesh.positions.size());
    range.clusterCount = static_cast<std::uint32_t>(mesh.clusters.size());
    range.receiverCount = range.clusterCount * kClusterReceivers;
    for (std::uint32_t i = 0; i < range.receiverCount; ++i) {
        const std::size_t v = std::min(i, range.vertexCount - 1);
        ReceiverTexels texels;
        const vec3 p = mesh.positions[v];
        texels.geometry = uvec4(floatBitsToUint(p.x), floatBitsToUint(p.y), floatBitsToUint(p.z),
                                packNormal(mesh.normals[v]));
        std::memcpy(&texels.selfVisibility, mesh.selfVisibility[v].data(),
                    sizeof(texels.selfVisibility));
        receivers.push_back(texels);
    }
}

// Kernels step through a cell of 2 x 2 x 2 nodes with fixed strides, so all shells get the side of
// the largest, and none is left out.
void appendField(const ShadowField& field, SceneData& scene)
{
    const std::uint32_t side = largestSide(field);
    FieldInput input{};
    input.center = field.center;
    input.radius = field.radius;
    input.bandScale =
        vec4(field.bandScale[0], field.bandScale[1], field.bandScale[2], field.bandScale[3]);
    input.firstSample = static_cast<std::uint32_t>(scene.fieldSamples.size());
    input.side = side;
    input.shells = static_cast<std::uint32_t>(field.shellSides.size());
    input.innerRadius = field.innerRadius;
    input.outerRadius = field.outerRadius;
    scene.fields.push_back(input);

    scene.fieldSamples.resize(scene.fieldSamples.size() + std::size_t{side} * side * input.shells);
    uvec4* const samples = scene.fieldSamples.data() + input.firstSample;
    const std::size_t nodes = std::size_t{side} * side;
    const std::vector<std::uint8_t> texels = refineField(field, 0);
    for (std::size_t s = 0; s < input.shells; ++s)
        for (std::size_t node = 0; node < nodes; ++node)
            std::memcpy(&samples[node * input.shells + s],
                        &texels[(s * nodes + node) * kFieldCoefficients], kFieldCoefficients);
}

} // namespace

SceneData buildSceneData(std::span<const MeshAsset* const> meshes,
                         std::vector<SceneInstance> instances)
{
    SceneData scene;
    for (const MeshAsset* mesh : meshes) {
        MeshRange range;
        appendReceivers(*mesh, range, scene.receivers);
        range.firstIndex = static_cast<std::uint32_t>(scene.indices.size());
        range.indexCount = static_cast<std::uint32_t>(mesh->indices.size());
        scene.indices.insert(scene.indices.end(), mesh->indices.begin(), mesh->indices.end());
        range.firstBounds = static_cast<std::uint32_t>(scene.bounds.size());
        for (const MeshCluster& cluster : mesh->clusters)
            scene.bounds.push_back({vec4(cluster.center, cluster.radius),
                                    vec4(cluster.faces.axis, cluster.faces.cutoff),
                                    vec4(cluster.vertices.axis, cluster.vertices.cutoff)});
        if (mesh->field) {
            range.field = static_cast<std::uint32_t>(scene.fields.size());
            appendField(*mesh->field, scene);
        }
        scene.meshes.push_back(range);
    }
    if (scene.fields.empty()) { // a scene without occluders still binds its buffers
        scene.fields.push_back({vec3(0), 1, vec4(0), 0, 2, 2, 0.2f, 8.0f, 0, 0, 0});
        scene.fieldSamples.assign(8, uvec4(0x80808080));
    }

    scene.instances = std::move(instances);
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        PENUMBRA_ASSERT(scene.instances[i].mesh < scene.meshes.size(),
                        "instance {} names mesh {} of {}", i, scene.instances[i].mesh,
                        scene.meshes.size());
        const MeshRange& mesh = scene.meshes[scene.instances[i].mesh];
        scene.firstRadiance.push_back(scene.radianceCount);
        for (std::uint32_t c = 0; c < mesh.clusterCount; ++c)
            scene.clusters.push_back({static_cast<std::uint32_t>(i), mesh.firstBounds + c,
                                      mesh.firstReceiver + c * kClusterReceivers,
                                      scene.radianceCount + c * kClusterReceivers});
        scene.radianceCount += mesh.receiverCount;
        scene.vertexCount += mesh.vertexCount;
        scene.triangleCount += mesh.indexCount / 3;
    }
    return scene;
}

InstanceInput instanceInput(const SceneData& scene, const SceneInstance& instance)
{
    InstanceInput input{};
    input.position = instance.position;
    input.scale = instance.scale;
    input.rotation = instance.rotation;
    input.albedo = instance.material.albedo;
    input.glossFraction = instance.material.glossFraction;
    input.glossExponent = instance.material.glossExponent;
    input.field = instance.occluder ? scene.meshes[instance.mesh].field : kNoField;
    return input;
}

} // namespace penumbra
