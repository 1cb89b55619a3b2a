#include "assetc/import/gltf.h"

#include "assetc/import/gltf_accessor.h"
#include "assetc/import/gltf_document.h"
#include "assetc/import/gltf_primitive.h"
#include "runtime/file.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

namespace penumbra {

namespace {

using glm::dmat3, glm::dmat4, glm::dquat, glm::dvec3, glm::dvec4;

dmat4 parentFromNode(const tinygltf::Node& node)
{
    if (!node.matrix.empty())
        return glm::make_mat4(node.matrix.data());
    dmat4 transform(1.0);
    if (!node.translation.empty())
        transform = glm::translate(transform, glm::make_vec3(node.translation.data()));
    if (!node.rotation.empty())
        transform *= glm::mat4_cast(
            dquat(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]));
    if (!node.scale.empty())
        transform = glm::scale(transform, glm::make_vec3(node.scale.data()));
    return transform;
}

// [nodeCount]. Nodes form a forest (checkModel), so the walk ends.
std::vector<dmat4> worldFromNodes(const tinygltf::Model& model)
{
    std::vector<dmat4> world(model.nodes.size(), dmat4(1.0));
    std::vector<bool> isChild(model.nodes.size(), false);
    for (const tinygltf::Node& node : model.nodes)
        for (const int child : node.children)
            isChild[static_cast<std::size_t>(child)] = true;
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < model.nodes.size(); ++i)
        if (!isChild[i]) {
            world[i] = parentFromNode(model.nodes[i]);
            open.push_back(i);
        }
    while (!open.empty()) {
        const std::size_t parent = open.back();
        open.pop_back();
        for (const int index : model.nodes[parent].children) {
            const auto child = static_cast<std::size_t>(index);
            world[child] = world[parent] * parentFromNode(model.nodes[child]);
            open.push_back(child);
        }
    }
    return world;
}

// Nodes of the default scene, or of the first, or all where the file has no scene; each once, in
// file order.
std::vector<std::size_t> sceneNodes(const tinygltf::Model& model)
{
    std::vector<bool> inScene(model.nodes.size(), model.scenes.empty());
    if (!model.scenes.empty()) {
        const tinygltf::Scene& scene =
            model.scenes[static_cast<std::size_t>(std::max(model.defaultScene, 0))];
        std::vector<int> open = scene.nodes;
        while (!open.empty()) {
            const auto node = static_cast<std::size_t>(open.back());
            open.pop_back();
            if (inScene[node])
                continue;
            inScene[node] = true;
            open.insert(open.end(), model.nodes[node].children.begin(),
                        model.nodes[node].children.end());
        }
    }
    std::vector<std::size_t> nodes;
    for (std::size_t i = 0; i < inScene.size(); ++i)
        if (inScene[i])
            nodes.push_back(i);
    return nodes;
}

// Transposed inverse times the determinant: turns normals rightly, mirrors included, and exists for
// flat scales too.
dmat3 cofactors(const dmat3& m)
{
    return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

class SceneMerger {
public:
    SceneMerger(const tinygltf::Model& model, ImportedMesh& out)
        : m_model(model), m_world(worldFromNodes(model)), m_out(out)
    {}

    Result<void> addNode(std::size_t nodeIndex)
    {
        const tinygltf::Node& node = m_model.nodes[nodeIndex];
        if (node.mesh == -1)
            return {};
        const tinygltf::Mesh& mesh = m_model.meshes[static_cast<std::size_t>(node.mesh)];
        const std::vector<double>& morphWeights =
            node.weights.empty() ? mesh.weights : node.weights;
        if (const auto joints = readJoints(node); !joints)
            return joints.error();
        for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
            const tinygltf::Primitive& primitive = mesh.primitives[p];
            if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
                warnOnce("points and lines are not read");
                continue;
            }
            if (!primitive.targets.empty())
                warnOnce("morph targets are baked with their default weights");
            const auto read = readPrimitive(m_model, primitive, morphWeights);
            const std::string place = fmt::format("meshes[{}].primitives[{}]", node.mesh, p);
            if (!read)
                return fail(read.error(), place);
            if (const auto added = addPrimitive(*read, nodeIndex, primitive.material); !added)
                return fail(added.error(), place);
        }
        return {};
    }

private:
    void warnOnce(const char* text)
    {
        if (std::find(m_out.warnings.begin(), m_out.warnings.end(), text) == m_out.warnings.end())
            m_out.warnings.emplace_back(text);
    }

    // World from bind space, per joint of the node's skin; none without a skin.
    Result<void> readJoints(const tinygltf::Node& node)
    {
        m_joints.clear();
        if (node.skin == -1)
            return {};
        warnOnce("skins are baked in the pose that the file stores");
        const tinygltf::Skin& skin = m_model.skins[static_cast<std::size_t>(node.skin)];
        std::vector<float> inverseBind;
        if (skin.inverseBindMatrices != -1) {
            auto read = readFloats(m_model, skin.inverseBindMatrices, TINYGLTF_TYPE_MAT4);
            if (!read)
                return read.error();
            inverseBind = std::move(*read);
        }
        for (std::size_t j = 0; j < skin.joints.size(); ++j) {
            const dmat4 bind =
                inverseBind.empty() ? dmat4(1.0) : dmat4(glm::make_mat4(&inverseBind[16 * j]));
            m_joints.push_back(m_world[static_cast<std::size_t>(skin.joints[j])] * bind);
        }
        return {};
    }

    // A skinned vertex follows its joints alone; the node's own transform does not count (glTF 2.0,
    // section 3.7.3.3).
    Result<dmat4> worldFromVertex(const GltfPrimitive& primitive, std::size_t vertex,
                                  std::size_t node) const
    {
        if (m_joints.empty() || primitive.joints.empty() || primitive.weights[vertex] == vec4{0})
            return m_world[node];
        dmat4 blend(0.0);
        for (int k = 0; k < 4; ++k) {
            const double weight = primitive.weights[vertex][k];
            if (weight == 0)
                continue;
            const std::uint32_t joint = primitive.joints[vertex][k];
            if (joint >= m_joints.size())
                return Error{fmt::format("vertex {} follows joint {} of {}", vertex, joint,
                                         m_joints.size())};
            blend += weight * m_joints[joint];
        }
        return blend;
    }

    Result<void> addPrimitive(const GltfPrimitive& primitive, std::size_t node, int material)
    {
        MeshAsset& mesh = m_out.mesh;
        if (mesh.positions.size() + primitive.positions.size() > kMaxMeshVertices ||
            (mesh.indices.size() + primitive.indices.size()) / 3 > kMaxMeshTriangles)
            return Error{
                fmt::format("the scene has more than {} vertices or {} triangles; simplify it",
                            kMaxMeshVertices, kMaxMeshTriangles)};
        const auto base = static_cast<std::uint32_t>(mesh.positions.size());
        bool mirrored = false;
        for (std::size_t i = 0; i < primitive.positions.size(); ++i) {
            const auto transform = worldFromVertex(primitive, i, node);
            if (!transform)
                return transform.error();
            const dmat3 linear(*transform);
            const double sign = glm::determinant(linear) < 0 ? -1 : 1;
            mirrored = i == 0 ? sign < 0 : mirrored;
            mesh.positions.emplace_back(*transform * dvec4(primitive.positions[i], 1.0));
            const dvec3 normal = sign * (cofactors(linear) * dvec3(primitive.normals[i]));
            const double size = glm::length(normal);
            mesh.normals.emplace_back(size > 0 ? normal / size : dvec3(0.0));
        }
        double area = 0;
        for (std::size_t t = 0; t < primitive.indices.size(); t += 3) {
            std::array<std::uint32_t, 3> corners = {base + primitive.indices[t],
                                                    base + primitive.indices[t + 1],
                                                    base + primitive.indices[t + 2]};
            if (mirrored)
                std::swap(corners[1], corners[2]);
            mesh.indices.insert(mesh.indices.end(), corners.begin(), corners.end());
            const dvec3 a(mesh.positions[corners[0]]);
            area += glm::length(glm::cross(dvec3(mesh.positions[corners[1]]) - a,
                                           dvec3(mesh.positions[corners[2]]) - a));
        }
        if (area > m_largestArea) {
            m_largestArea = area;
            mesh.material = {};
            if (material != -1) {
                const auto& factor = m_model.materials[static_cast<std::size_t>(material)]
                                         .pbrMetallicRoughness.baseColorFactor;
                for (int c = 0; c < 3 && factor.size() >= 3; ++c)
                    mesh.material.albedo[c] =
                        clamp(static_cast<float>(factor[static_cast<std::size_t>(c)]), 0.0f, 1.0f);
            }
        }
        return {};
    }

    const tinygltf::Model& m_model;
    std::vector<dmat4> m_world;  // [nodeCount]
    std::vector<dmat4> m_joints; // of the node at hand
    double m_largestArea = -1;
    ImportedMesh& m_out;
};

} // namespace

Result<ImportedMesh> importGltf(const std::filesystem::path& path, std::vector<AskedFile>* asked)
{
    const auto bytes = readFile(path, kMaxSourceBytes);
    return bytes ? importGltfBytes(*bytes, path.parent_path(), asked) : bytes.error();
}

Result<ImportedMesh> importGltfBytes(std::span<const std::byte> bytes,
                                     const std::filesystem::path& folder,
                                     std::vector<AskedFile>* asked)
{
    ImportedMesh out;
    const auto model = loadGltf(bytes, folder, out.warnings, asked);
    if (!model)
        return model.error();
    SceneMerger merger(*model, out);
    for (const std::size_t node : sceneNodes(*model))
        if (const auto added = merger.addNode(node); !added)
            return added.error();
    return out;
}

} // namespace penumbra
