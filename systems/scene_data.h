// A scene as flat arrays, in the order in which CPU and GPU walk them: what GpuScene uploads and
// the CPU kernels read. Fields, receivers, triangles and cluster bounds are stored once per asset,
// whatever the number of instances.
#pragma once

#include "assets/mesh_asset.h"
#include "shaders/shared/instance.h"
#include "shaders/shared/transfer.h"
#include "systems/surface_data.h"

#include <optional>
#include <span>
#include <vector>

namespace penumbra {

struct SceneInstance {
    std::uint32_t mesh = 0; // index of an asset
    vec3 position{0};       // world, metres
    float scale = 1;
    vec4 rotation{0, 0, 0, 1}; // quaternion x, y, z, w
    MeshMaterial material;
    bool repainted = false; // the albedo is the instance's own: instead of that of each material
    std::optional<std::uint32_t> occluder; // asset whose field says what the instance blocks
    vec3 emission{0};                      // factor of the mesh's own radiance
};

// A local light. Radiance does not change with the scale, so power goes with its square.
struct SceneLight {
    std::uint32_t asset = 0; // with a radiance field
    vec3 position{0};        // world, metres
    float scale = 1;
    vec4 rotation{0, 0, 0, 1}; // quaternion x, y, z, w
    vec3 intensity{1};         // factor of the field
    // The instance that is its surface: it is not lit by the light, and does not dim it beyond what
    // the field knows.
    std::optional<std::uint32_t> owner;
};

// Where an asset lies in the arrays below.
struct MeshRange {
    std::uint32_t firstReceiver = 0, receiverCount = 0; // count: a multiple of kClusterReceivers
    std::uint32_t vertexCount = 0;
    std::uint32_t firstIndex = 0, indexCount = 0;
    // What casts shadows into maps: a coarse level of the mesh.
    std::uint32_t firstCasterVertex = 0, firstCasterIndex = 0, casterIndexCount = 0;
    float casterError = 0; // of the level, metres
    std::uint32_t firstBounds = 0, clusterCount = 0;
    std::uint32_t field = kNoField;
    FieldKind fieldKind = FieldKind::Occlusion;
    vec3 emission{0}; // of its first material: W/(m² sr)
    SurfaceRange surface;
};

struct SceneData {
    std::vector<MeshRange> meshes;
    std::vector<ReceiverTexels>
        receivers; // last cluster of a mesh padded with copies of its last vertex
    std::vector<std::uint32_t> indices; // relative to the mesh's firstReceiver
    std::vector<vec3> casterPositions;
    std::vector<std::uint32_t> casterIndices; // relative to the mesh's firstCasterVertex
    std::vector<ClusterBounds> bounds;
    std::vector<FieldInput> fields;  // at least one
    std::vector<uvec4> fieldSamples; // of a field [channel][y][x][shell], one side: its largest
    SurfaceData surfaces;

    std::vector<SceneInstance> instances;
    std::vector<SceneLight> lights;
    // [instanceCount] whose inscribed ball hides others: the large ones, by their first scale
    std::vector<bool> hiders;
    std::vector<SceneCluster> clusters; // [sum over instances of clusterCount]
    std::vector<std::uint32_t>
        firstRadiance; // [instanceCount] of the instance's receivers in the radiance buffer
    std::uint32_t radianceCount = 0;
    std::vector<std::uint32_t> firstDraw;             // [instanceCount + 1] in the draw commands
    std::uint64_t vertexCount = 0, triangleCount = 0; // of all instances, without padding
};

// Every instance and light names an asset below meshes.size(), a light one with a radiance field,
// an occluder one with an occlusion field (asserted).
SceneData buildSceneData(std::span<const MeshAsset* const> meshes,
                         std::vector<SceneInstance> instances, std::vector<SceneLight> lights = {});

// Rows of the GPU's instance table: instances, then lights.
std::uint32_t rowCount(const SceneData& scene);
InstanceInput rowInput(const SceneData& scene, std::uint32_t row);

// What the receivers of an instance reflect: white where its mesh has a surface, which then knows
// the colours.
MeshMaterial receiverMaterial(const SceneData& scene, const SceneInstance& instance);

// Draw commands of an instance: one per part of its surface, or one.
std::uint32_t drawCount(const MeshRange& mesh);

// What pass raster pushes for a part of the instance's surface.
SurfacePush surfacePush(const SceneInstance& instance, const SurfacePart& part);

} // namespace penumbra
