// A compiled mesh asset in memory: receivers (vertices with self-visibility, in clusters of 64),
// triangles, material and the occlusion field that all instances share. On disk it is a .glb, see
// assets/mesh_codec.h and docs/asset_format.md.
#pragma once

#include "assets/shadow_field.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace penumbra {

PENUMBRA_CONST std::uint32_t kClusterVertices = 64;

// Self-visibility of one vertex: visibility in SH of order 4, object space; directions below the
// vertex's own tangent plane count as visible, since the cosine removes them and the function stays
// smooth without the step.
//     c_i = unoccluded_i + kSelfVisibilityScale * (q_i - 128)
// An open vertex is (128, 128, …).
using SelfVisibility = std::array<std::uint8_t, 16>;
PENUMBRA_CONST float kSelfVisibilityScale =
    1.78f / 127.0f; // a blocked hemisphere has |c_0| = sqrt(pi) = 1.7725

// All directions within an angle of an axis.
struct NormalCone {
    vec3 axis{0};      // the mean direction
    float cutoff = -1; // cosine of the largest angle between axis and direction; -1: no cone
};

// 64 consecutive vertices (fewer in the last cluster). Bounds cover every triangle that touches one
// of them, so that a cluster is dropped only when none of its triangles can be seen.
struct MeshCluster {
    vec3 center{0}; // object space, metres
    float radius = 0;
    NormalCone faces;    // face normals: where the cluster can be seen from
    NormalCone vertices; // vertex normals: what its receivers can be lit from
};

struct MeshMaterial {
    vec3 albedo{0.8f};       // linear Rec. 709
    float glossFraction = 0; // part of the reflectance in the Phong lobe, 0 = Lambert
    float glossExponent = 0; // normalised Phong exponent
};

struct MeshAsset {
    std::string name;
    std::vector<vec3> positions;                // [vertexCount] object space, metres
    std::vector<vec3> normals;                  // [vertexCount] unit
    std::vector<SelfVisibility> selfVisibility; // [vertexCount]
    std::vector<std::uint32_t> indices;         // [3 * triangleCount] counter-clockwise outside
    std::vector<MeshCluster> clusters;          // [ceil(vertexCount / 64)]
    MeshMaterial material;
    vec3 boundsMin{0};
    vec3 boundsMax{0};
    std::optional<ShadowField> field;
};

PENUMBRA_CONST std::uint32_t kMaxMeshVertices = 4u << 20;
PENUMBRA_CONST std::uint32_t kMaxMeshTriangles = 8u << 20;
PENUMBRA_CONST std::uint32_t kMaxNameBytes = 256;
PENUMBRA_CONST float kMaxGlossExponent = 1e5f;

// Bounds of the clusters for a mesh as it stands: one normal per position, indices below
// positions.size(). Normals that point all ways give no cone.
std::vector<MeshCluster> buildClusters(const std::vector<vec3>& positions,
                                       const std::vector<vec3>& normals,
                                       const std::vector<std::uint32_t>& indices);

// Sets clusters and bounds from positions, normals and indices.
void updateDerived(MeshAsset& mesh);

// Every invariant above but clusters and bounds, on untrusted values: sizes that agree and keep the
// limits, indices in range, finite positions within kMaxCoordinate, unit normals, a physical
// material, a valid field.
Result<void> validateMesh(const MeshAsset& mesh);

} // namespace penumbra
