// The node hierarchy of a glTF file.
#pragma once

#include "assetc/import/gltf_document.h"

namespace penumbra {

// [nodeCount]. The node that has it as a child; -1: none.
std::vector<int> parentsOfNodes(const tinygltf::Model& model);

// [nodeCount]
std::vector<glm::dmat4> worldFromNodes(const tinygltf::Model& model);

// Nodes of the default scene, or of the first, or all where the file has no scene; each once, in
// file order.
std::vector<std::size_t> sceneNodes(const tinygltf::Model& model);

// Where a node shows its mesh, in its own space: of EXT_mesh_gpu_instancing at most kMaxInstances,
// or once as it is.
Result<std::vector<glm::dmat4>> nodeFromInstances(const GltfDocument& document, std::size_t node);
PENUMBRA_CONST std::size_t kMaxInstances = 1u << 18; // of a node; with 2 MiB of input at least
bool hasInstances(const GltfDocument& document, std::size_t node);

// Lights of the scene's nodes, and the node of each.
struct PlacedLight {
    MeshLight light;
    std::size_t node;
};
Result<std::vector<PlacedLight>> lightsOfNodes(const GltfDocument& document,
                                               const std::vector<glm::dmat4>& worldFromNode);

} // namespace penumbra
