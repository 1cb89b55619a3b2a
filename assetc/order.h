// The order of vertices, which makes the clusters: every 64 consecutive vertices are one
// (assets/mesh_asset.h).
#pragma once

#include "assets/mesh_asset.h"

#include <string>

namespace penumbra {

// How well an order suits the cull pass: small spheres and narrow cones drop more.
struct ClusterQuality {
    float meanRadius = 0; // over the bounding radius of the mesh
    float meanCutoff = 0; // mean cone cutoff: 1 flat, -1 no cone
    float conelessPart =
        0;          // part of the clusters whose cone is wider than a half space and never culls
    float cost = 0; // what orderClusters minimises
};

ClusterQuality measureClusters(const MeshGeometry& mesh);

struct OrderReport {
    std::string method; // the better one: "meshlets" or "median split"
    ClusterQuality quality;
};

// Reorders the vertices of a clean mesh so that clusters are compact in place and normal, then the
// triangles for the vertex cache, both within their submeshes: a cluster may hold the end of one
// submesh and the beginning of the next. Deterministic. Leaves clusters and bounds as they were
// (updateDerived).
OrderReport orderClusters(MeshGeometry& mesh);

// The two candidates: a vertex order as old index per new place.
std::vector<std::uint32_t> orderByMeshlets(const MeshGeometry& mesh);
std::vector<std::uint32_t> orderByMedianSplit(const MeshGeometry& mesh);

// Moves vertex order[i] to place i.
void applyOrder(MeshGeometry& mesh, const std::vector<std::uint32_t>& order);

} // namespace penumbra
