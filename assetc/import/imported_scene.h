// What an importer hands on where each rigid node becomes an entity (assetc bake --per-node).
#pragma once

#include "assetc/import/imported_mesh.h"
#include "assetc/import/similarity.h"

namespace penumbra {

struct SceneNode {
    std::string name;
    int parent = -1; // of ImportedScene::nodes, before this one; -1: none
    Similarity parentFromNode;
    int mesh = -1; // of ImportedScene::meshes; -1: none
};

struct SceneLight {
    MeshLight light; // shines along the node's -z; position and direction do not count
    int node = 0;    // of ImportedScene::nodes
};

struct ImportedScene {
    std::vector<MeshAsset> meshes; // as ImportedMesh::mesh in its node's space, without materials
                                   // and images: those below are for all
    std::vector<SurfaceMaterial> materials;
    std::vector<MeshImage> images;
    std::vector<SceneNode> nodes;
    std::vector<SceneLight> lights;
    std::vector<std::string> warnings;
};

PENUMBRA_CONST std::size_t kMaxSceneNodes = 1u << 16;

} // namespace penumbra
