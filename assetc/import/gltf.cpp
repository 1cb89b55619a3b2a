#include "assetc/import/gltf.h"

#include "assetc/import/gltf_material.h"
#include "assetc/import/gltf_mesh.h"
#include "assetc/import/gltf_nodes.h"

namespace penumbra {

Result<ImportedMesh> importGltfBytes(std::span<const std::byte> bytes,
                                     const std::filesystem::path& folder,
                                     std::vector<AskedFile>* asked)
{
    ImportedMesh out;
    const auto document = loadGltf(bytes, folder, out.warnings, asked);
    if (!document)
        return document.error();
    const std::vector<glm::dmat4> worldFromNode = worldFromNodes(document->model);
    GltfMeshes meshes(*document, out.warnings);
    for (const std::size_t node : sceneNodes(document->model)) {
        auto transforms = nodeFromInstances(*document, node);
        if (!transforms)
            return transforms.error();
        for (glm::dmat4& transform : *transforms)
            transform = worldFromNode[node] * transform;
        if (const auto added = meshes.append(node, *transforms, out.mesh); !added)
            return added.error();
    }
    auto materials = readGltfMaterials(*document, meshes.usedMaterials(), out.warnings);
    if (!materials)
        return materials.error();
    out.mesh.materials = std::move(materials->materials);
    out.mesh.images = std::move(materials->images);
    out.mesh.material = out.mesh.materials[largestMaterial(out.mesh)];
    const auto lights = lightsOfNodes(*document, worldFromNode);
    if (!lights)
        return lights.error();
    for (const PlacedLight& placed : *lights)
        out.mesh.lights.push_back(placed.light);
    return out;
}

} // namespace penumbra
