#include "systems/scene_data.h"

#include "shaders/shared/visibility.h"

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

// Of the mesh's size. Receivers are lifted by as much: what touches them within it casts no shadow
// (docs/decisions/0015).
constexpr float kMaxCasterError = 0.001f;

// The coarsest level that a shadow map cannot tell from the mesh.
void appendCaster(const MeshAsset& mesh, MeshRange& range, SceneData& scene)
{
    const float limit = kMaxCasterError * length(mesh.boundsMax - mesh.boundsMin);
    const MeshGeometry* caster = &mesh;
    for (const MeshLod& lod : mesh.lods) {
        if (lod.error > limit)
            break;
        caster = &lod;
        range.casterError = lod.error;
    }
    range.firstCasterVertex = static_cast<std::uint32_t>(scene.casterPositions.size());
    range.firstCasterIndex = static_cast<std::uint32_t>(scene.casterIndices.size());
    range.casterIndexCount = static_cast<std::uint32_t>(caster->indices.size());
    scene.casterPositions.insert(scene.casterPositions.end(), caster->positions.begin(),
                                 caster->positions.end());
    scene.casterIndices.insert(scene.casterIndices.end(), caster->indices.begin(),
                               caster->indices.end());
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
    input.inscribed = field.inscribed;
    input.firstSample = static_cast<std::uint32_t>(scene.fieldSamples.size());
    input.side = side;
    input.shells = static_cast<std::uint32_t>(field.shellSides.size());
    input.innerRadius = field.innerRadius;
    input.outerRadius = field.outerRadius;
    scene.fields.push_back(input);

    const std::size_t nodes = std::size_t{side} * side;
    for (std::uint32_t channel = 0; channel < field.channels; ++channel) {
        const std::vector<std::uint8_t> texels = refineField(field, channel);
        const std::size_t first = scene.fieldSamples.size();
        scene.fieldSamples.resize(first + nodes * input.shells);
        for (std::size_t s = 0; s < input.shells; ++s)
            for (std::size_t node = 0; node < nodes; ++node)
                std::memcpy(&scene.fieldSamples[first + node * input.shells + s],
                            &texels[(s * nodes + node) * kFieldCoefficients], kFieldCoefficients);
    }
}

// Of a field's place in the world; the rest is zero.
InstanceInput placed(vec3 position, float scale, vec4 rotation)
{
    InstanceInput input{};
    input.position = position;
    input.scale = scale;
    input.rotation = rotation;
    input.field = kNoField;
    input.owner = kNoOwner;
    return input;
}

bool hasField(const SceneData& scene, std::uint32_t asset, FieldKind kind)
{
    return asset < scene.meshes.size() && scene.meshes[asset].field != kNoField &&
           scene.meshes[asset].fieldKind == kind;
}

void checkNames(const SceneData& scene)
{
    for (const SceneInstance& instance : scene.instances) {
        PENUMBRA_ASSERT(instance.mesh < scene.meshes.size(), "an instance names mesh {} of {}",
                        instance.mesh, scene.meshes.size());
        PENUMBRA_ASSERT(!instance.occluder ||
                            hasField(scene, *instance.occluder, FieldKind::Occlusion),
                        "an instance blocks light by asset {}, which has no occlusion field",
                        *instance.occluder);
    }
    for (const SceneLight& light : scene.lights)
        PENUMBRA_ASSERT(hasField(scene, light.asset, FieldKind::Radiance),
                        "a light shines by asset {}, which has no radiance field", light.asset);
}

// How large a ball must be to hide others, compared with the usual entity: what smaller ones hide
// is less than it costs (docs/decisions/0011).
constexpr float kHiderSize = 1.2f;

// Which instances hide others: [instances].
std::vector<bool> findHiders(const SceneData& scene)
{
    std::vector<float> radii;
    const auto radius = [&](std::uint32_t asset, float scale) {
        return scale * scene.fields[scene.meshes[asset].field].radius;
    };
    for (const SceneInstance& instance : scene.instances)
        if (instance.occluder)
            radii.push_back(radius(*instance.occluder, instance.scale));
    for (const SceneLight& light : scene.lights)
        radii.push_back(radius(light.asset, light.scale));
    std::vector<bool> hiders(scene.instances.size());
    if (radii.empty())
        return hiders;
    const auto middle = radii.begin() + static_cast<std::ptrdiff_t>((radii.size() - 1) / 2);
    std::nth_element(radii.begin(), middle, radii.end());
    for (std::size_t i = 0; i < hiders.size(); ++i)
        if (const SceneInstance& instance = scene.instances[i]; instance.occluder) {
            const FieldInput& field = scene.fields[scene.meshes[*instance.occluder].field];
            hiders[i] = field.outerRadius >= kHiderReach &&
                        instance.scale * field.inscribed.w >= kHiderSize * *middle;
        }
    return hiders;
}

} // namespace

SceneData buildSceneData(std::span<const MeshAsset* const> meshes,
                         std::vector<SceneInstance> instances, std::vector<SceneLight> lights)
{
    SceneData scene;
    for (const MeshAsset* mesh : meshes) {
        MeshRange range;
        appendReceivers(*mesh, range, scene.receivers);
        range.firstIndex = static_cast<std::uint32_t>(scene.indices.size());
        range.indexCount = static_cast<std::uint32_t>(mesh->indices.size());
        scene.indices.insert(scene.indices.end(), mesh->indices.begin(), mesh->indices.end());
        appendCaster(*mesh, range, scene);
        range.firstBounds = static_cast<std::uint32_t>(scene.bounds.size());
        for (const MeshCluster& cluster : mesh->clusters)
            scene.bounds.push_back({vec4(cluster.center, cluster.radius),
                                    vec4(cluster.faces.axis, cluster.faces.cutoff),
                                    vec4(cluster.vertices.axis, cluster.vertices.cutoff)});
        if (mesh->field) {
            range.field = static_cast<std::uint32_t>(scene.fields.size());
            range.fieldKind = mesh->field->kind;
            appendField(*mesh->field, scene);
        }
        if (!mesh->materials.empty())
            range.emission = mesh->materials.front().emissive;
        const auto index = static_cast<std::uint32_t>(scene.meshes.size());
        range.surface = appendSurface(*mesh, index, range.receiverCount, scene.surfaces);
        scene.meshes.push_back(range);
    }
    if (scene.fields.empty()) { // a scene without occluders still binds its buffers
        scene.fields.push_back({vec3(0), 1, vec4(0), vec4(0), 0, 2, 2, 0.2f, 8.0f, 0, 0, 0});
        scene.fieldSamples.assign(8, uvec4(0x80808080));
    }

    scene.instances = std::move(instances);
    scene.lights = std::move(lights);
    checkNames(scene);
    scene.hiders = findHiders(scene);
    scene.firstDraw.push_back(0);
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const MeshRange& mesh = scene.meshes[scene.instances[i].mesh];
        scene.firstDraw.push_back(scene.firstDraw.back() + drawCount(mesh));
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

std::uint32_t rowCount(const SceneData& scene)
{
    return static_cast<std::uint32_t>(scene.instances.size() + scene.lights.size());
}

InstanceInput rowInput(const SceneData& scene, std::uint32_t row)
{
    if (row >= scene.instances.size()) {
        const SceneLight& light = scene.lights[row - scene.instances.size()];
        InstanceInput input = placed(light.position, light.scale, light.rotation);
        input.albedo = light.intensity;
        input.field = scene.meshes[light.asset].field;
        input.owner = light.owner.value_or(kNoOwner);
        return input;
    }
    const SceneInstance& instance = scene.instances[row];
    const MeshRange& mesh = scene.meshes[instance.mesh];
    InstanceInput input = placed(instance.position, instance.scale, instance.rotation);
    const MeshMaterial material = receiverMaterial(scene, instance);
    input.albedo = material.albedo;
    input.glossFraction = material.glossFraction;
    input.glossExponent = material.glossExponent;
    if (mesh.surface.plain())
        input.emission = instance.emission * mesh.emission;
    input.firstDraw = scene.firstDraw[row];
    input.drawCount = drawCount(mesh);
    if (instance.occluder)
        input.field = scene.meshes[*instance.occluder].field;
    input.hides = scene.hiders[row] ? 1 : 0;
    return input;
}

MeshMaterial receiverMaterial(const SceneData& scene, const SceneInstance& instance)
{
    MeshMaterial material = instance.material;
    if (!scene.meshes[instance.mesh].surface.plain())
        material.albedo = vec3(1);
    return material;
}

std::uint32_t drawCount(const MeshRange& mesh)
{
    return std::max(mesh.surface.partCount, 1u);
}

SurfacePush surfacePush(const SceneInstance& instance, const SurfacePart& part)
{
    return {instance.repainted ? instance.material.albedo : part.albedo, part.alpha,
            instance.emission * part.emissive, part.alphaCutoff};
}

} // namespace penumbra
