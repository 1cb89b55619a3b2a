// A compiled mesh asset in memory: receivers (vertices with self-visibility, in clusters of 64),
// triangles, materials, levels of detail and the occlusion field that all instances share. On disk
// it is a .glb, see assets/mesh_codec.h and docs/asset_format.md.
#pragma once

#include "assets/mesh_light.h"
#include "assets/mesh_material.h"
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

// Triangles and vertices of one material: ranges of MeshGeometry's arrays. Nothing of another
// submesh uses these vertices.
struct Submesh {
    std::uint32_t firstIndex = 0, indexCount = 0;
    std::uint32_t firstVertex = 0, vertexCount = 0;
    std::uint32_t material = 0; // of MeshAsset::materials
    bool operator==(const Submesh&) const = default;
};

using VertexColor = std::array<std::uint8_t, 4>; // linear RGBA, a factor of the base colour

// Clusters know no submeshes: they are 64 consecutive vertices of the whole.
struct MeshGeometry {
    std::vector<vec3> positions;                // [vertexCount] object space, metres
    std::vector<vec3> normals;                  // [vertexCount] unit
    std::vector<SelfVisibility> selfVisibility; // [vertexCount]
    std::vector<std::uint32_t> indices;         // [3 * triangleCount] counter-clockwise outside
    std::vector<MeshCluster> clusters;          // [ceil(vertexCount / 64)]
    std::vector<vec2> texcoords0, texcoords1;   // [vertexCount], or empty: none
    std::vector<VertexColor> colors;            // [vertexCount], or empty: white
    std::vector<Submesh> submeshes;             // in the arrays' order, covering them;
                                                // empty: all is one, of MeshAsset::material
};

// The mesh with fewer triangles. Its vertices are vertices of the full mesh.
struct MeshLod : MeshGeometry {
    float error = 0; // metres: how far, as the simplifier estimates it, its surface leaves the full
                     // mesh's; one-sided
};

struct MeshAsset : MeshGeometry {
    std::string name;
    MeshMaterial material; // of the submesh with the largest area, where there are `materials`
    std::vector<SurfaceMaterial> materials;
    std::vector<MeshImage> images;
    std::vector<MeshLight> lights;
    std::vector<MeshLod> lods; // each coarser than the one before
    vec3 boundsMin{0};
    vec3 boundsMax{0};
    std::optional<ShadowField> field;
};

PENUMBRA_CONST std::uint32_t kMaxMeshVertices = 4u << 20;
PENUMBRA_CONST std::uint32_t kMaxMeshTriangles = 8u << 20;
PENUMBRA_CONST std::uint32_t kMaxMeshLods = 4;
PENUMBRA_CONST std::uint32_t kMaxNameBytes = 256;

// The submeshes, or the one that an empty list stands for.
std::vector<Submesh> submeshesOf(const MeshGeometry& geometry);

// The one list of the arrays that have an element per vertex, `clusters` aside. What moves, merges
// or drops vertices does it through this or gatherVertices.
template <class Geometry, class Visit>
void forEachVertexArray(Geometry& geometry, const Visit& visit)
{
    visit(geometry.positions);
    visit(geometry.normals);
    visit(geometry.selfVisibility);
    visit(geometry.texcoords0);
    visit(geometry.texcoords1);
    visit(geometry.colors);
}

// Makes vertex i what vertex from[i] was, in every array that is not empty.
void gatherVertices(MeshGeometry& geometry, const std::vector<std::uint32_t>& from);

// Index of the material with the largest area; 0 for a mesh without triangles.
std::uint32_t largestMaterial(const MeshGeometry& geometry);

// Bounds of the clusters for a mesh as it stands: one normal per position, indices below
// positions.size(). Normals that point all ways give no cone.
std::vector<MeshCluster> buildClusters(const std::vector<vec3>& positions,
                                       const std::vector<vec3>& normals,
                                       const std::vector<std::uint32_t>& indices);

// Sets clusters (of LODs too), bounds and `material`.
void updateDerived(MeshAsset& mesh);

// Every invariant above but clusters and bounds, on untrusted values: sizes that agree and keep the
// limits, indices in range, finite positions within kMaxCoordinate, unit normals, physical
// materials and lights, images of their type, a valid field.
Result<void> validateMesh(const MeshAsset& mesh);

} // namespace penumbra
