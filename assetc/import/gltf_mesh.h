// Meshes of a glTF file as triangles in one space.
#pragma once

#include "assetc/import/gltf_document.h"

namespace penumbra {

class GltfMeshes {
public:
    GltfMeshes(const GltfDocument& document, std::vector<std::string>& warnings);

    // Appends what the node shows to `out`, a submesh per primitive, once for each transform from
    // mesh space. A node with a skin is posed by its joints instead, in world space, once.
    Result<void> append(std::size_t node, const std::vector<glm::dmat4>& targetFromMesh,
                        MeshAsset& out);

    // [materialCount + 1] of the appended primitives; the last for those without a material.
    [[nodiscard]] const std::vector<bool>& usedMaterials() const { return m_usedMaterials; }

private:
    void warnOnce(const char* text);
    Result<std::vector<glm::dmat4>> readJoints(const tinygltf::Node& node);

    const GltfDocument& m_document;
    std::vector<glm::dmat4> m_worldFromNode;
    std::vector<bool> m_usedMaterials;
    std::vector<std::string>& m_warnings;
};

} // namespace penumbra
