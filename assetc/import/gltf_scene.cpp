#include "assetc/import/gltf_scene.h"

#include "assetc/import/gltf_material.h"
#include "assetc/import/gltf_mesh.h"
#include "assetc/import/gltf_nodes.h"

#include <algorithm>
#include <map>

namespace penumbra {

namespace {

using glm::dmat3, glm::dmat4;

bool isFinite(const dmat4& m)
{
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 3; ++r)
            if (!(std::abs(m[c][r]) <= kMaxCoordinate))
                return false;
    return true;
}

class SceneImporter {
public:
    SceneImporter(const GltfDocument& document, ImportedScene& out)
        : m_document(document), m_meshes(document, out.warnings),
          m_world(worldFromNodes(document.model)), m_placeOf(document.model.nodes.size(), -1),
          m_out(out)
    {}

    // In the order of depth-first search, so that parents come first.
    Result<void> addNodes()
    {
        const tinygltf::Model& model = m_document.model;
        const std::vector<std::size_t> nodes = sceneNodes(model);
        const std::vector<int> parents = parentsOfNodes(model);
        std::vector<bool> inScene(model.nodes.size(), false);
        for (const std::size_t node : nodes)
            inScene[node] = true;
        std::vector<std::size_t> open;
        for (auto node = nodes.rbegin(); node != nodes.rend(); ++node)
            if (parents[*node] == -1 || !inScene[static_cast<std::size_t>(parents[*node])])
                open.push_back(*node);
        while (!open.empty()) {
            const std::size_t node = open.back();
            open.pop_back();
            const int parent = parents[node];
            const int place = parent == -1 ? -1 : m_placeOf[static_cast<std::size_t>(parent)];
            if (const auto added = addNode(node, place); !added)
                return fail(added.error(),
                            fmt::format("nodes[{}] \"{}\"", node, model.nodes[node].name));
            const std::vector<int>& children = model.nodes[node].children;
            for (auto child = children.rbegin(); child != children.rend(); ++child)
                open.push_back(static_cast<std::size_t>(*child));
        }
        return {};
    }

    Result<void> addMaterialsAndLights()
    {
        auto materials = readGltfMaterials(m_document, m_meshes.usedMaterials(), m_out.warnings);
        if (!materials)
            return materials.error();
        m_out.materials = std::move(materials->materials);
        m_out.images = std::move(materials->images);
        const auto lights = lightsOfNodes(m_document, m_world);
        if (!lights)
            return lights.error();
        for (const PlacedLight& placed : *lights)
            m_out.lights.push_back({placed.light, m_placeOf[placed.node]});
        return {};
    }

private:
    Result<void> addNode(std::size_t node, int parent)
    {
        const tinygltf::Node& source = m_document.model.nodes[node];
        if (source.mesh != -1 && source.skin != -1)
            return Error{"has a skin, which is not rigid; bake without --per-node (the pose that "
                         "the file stores), or remove the skin"};
        std::string name = source.name;
        if (name.empty() && source.mesh != -1)
            name = m_document.model.meshes[static_cast<std::size_t>(source.mesh)].name;
        if (name.empty())
            name = fmt::format("node {}", node);
        m_placeOf[node] = static_cast<int>(m_out.nodes.size());
        if (!hasInstances(m_document, node))
            return addEntity(node, name, parent, m_world[node], source.mesh != -1);
        if (const auto added = addEntity(node, name, parent, m_world[node], false); !added)
            return added;
        const auto instances = nodeFromInstances(m_document, node);
        if (!instances)
            return instances.error();
        for (std::size_t i = 0; i < instances->size(); ++i)
            if (const auto added =
                    addEntity(node, fmt::format("{} {}", name, i + 1), m_placeOf[node],
                              m_world[node] * (*instances)[i], source.mesh != -1);
                !added)
                return added;
        return {};
    }

    Result<void> addEntity(std::size_t node, const std::string& name, int parent,
                           const dmat4& world, bool showsMesh)
    {
        if (m_out.nodes.size() == kMaxSceneNodes)
            return Error{fmt::format("more than {} nodes and instances", kMaxSceneNodes)};
        if (!isFinite(world))
            return Error{fmt::format("a transform beyond {} m or not finite", kMaxCoordinate)};
        const SplitTransform split = splitTransform(world);
        SceneNode entity{name.substr(0, kMaxNameBytes), parent};
        entity.parentFromNode =
            parent == -1
                ? split.similarity
                : relativeTo(m_similarities[static_cast<std::size_t>(parent)], split.similarity);
        if (showsMesh) {
            const auto mesh = meshOf(node, split.rest, name);
            if (!mesh)
                return mesh.error();
            entity.mesh = *mesh;
        }
        m_out.nodes.push_back(std::move(entity));
        m_similarities.push_back(split.similarity);
        return {};
    }

    // The mesh that `rest` makes of the node's; -1 where that has no triangles.
    Result<int> meshOf(std::size_t node, const dmat3& rest, const std::string& name)
    {
        const tinygltf::Node& source = m_document.model.nodes[node];
        std::vector<double> key = {static_cast<double>(source.mesh)};
        for (int c = 0; c < 3; ++c)
            for (int r = 0; r < 3; ++r)
                key.push_back(rest[c][r] + 0.0);
        key.insert(key.end(), source.weights.begin(), source.weights.end());
        const auto [found, isNew] = m_meshOf.emplace(key, -1);
        if (!isNew)
            return found->second;
        MeshAsset mesh;
        mesh.name = name.substr(0, kMaxNameBytes);
        if (const auto added = m_meshes.append(node, {dmat4(rest)}, mesh); !added)
            return added.error();
        if (mesh.indices.empty() || rest == dmat3(0.0)) {
            m_out.warnings.push_back(
                fmt::format("nodes[{}] \"{}\": no triangles; kept without a mesh", node, name));
            return -1;
        }
        found->second = static_cast<int>(m_out.meshes.size());
        m_out.meshes.push_back(std::move(mesh));
        return found->second;
    }

    const GltfDocument& m_document;
    GltfMeshes m_meshes;
    std::vector<dmat4> m_world;             // [nodeCount]
    std::vector<int> m_placeOf;             // [nodeCount] of the output's nodes
    std::vector<Similarity> m_similarities; // [output's nodes] world from node
    std::map<std::vector<double>, int> m_meshOf;
    ImportedScene& m_out;
};

} // namespace

Result<ImportedScene> importGltfScene(std::span<const std::byte> bytes,
                                      const std::filesystem::path& folder,
                                      std::vector<AskedFile>* asked)
{
    ImportedScene out;
    const auto document = loadGltf(bytes, folder, out.warnings, asked);
    if (!document)
        return document.error();
    SceneImporter importer(*document, out);
    if (const auto added = importer.addNodes(); !added)
        return added.error();
    if (const auto added = importer.addMaterialsAndLights(); !added)
        return added.error();
    return out;
}

} // namespace penumbra
