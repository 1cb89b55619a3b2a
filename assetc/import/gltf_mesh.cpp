#include "assetc/import/gltf_mesh.h"

#include "assetc/import/gltf_accessor.h"
#include "assetc/import/gltf_nodes.h"
#include "assetc/import/gltf_primitive.h"

#include <algorithm>
#include <glm/gtc/type_ptr.hpp>

namespace penumbra {

namespace {

using glm::dmat3, glm::dmat4, glm::dvec3, glm::dvec4;

// Transposed inverse times the determinant: turns normals rightly, mirrors included, and exists for
// flat scales too.
dmat3 cofactors(const dmat3& m)
{
    return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

// A skinned vertex follows its joints alone; the node's own transform does not count (glTF 2.0,
// section 3.7.3.3). `target` is for a vertex without weights.
Result<dmat4> blendJoints(const GltfPrimitive& primitive, std::size_t vertex,
                          const std::vector<dmat4>& joints, const dmat4& target)
{
    if (primitive.joints.empty() || primitive.weights[vertex] == vec4{0})
        return target;
    dmat4 blend(0.0);
    for (int k = 0; k < 4; ++k) {
        const double weight = primitive.weights[vertex][k];
        if (weight == 0)
            continue;
        const std::uint32_t joint = primitive.joints[vertex][k];
        if (joint >= joints.size())
            return Error{
                fmt::format("vertex {} follows joint {} of {}", vertex, joint, joints.size())};
        blend += weight * joints[joint];
    }
    return blend;
}

// Appends `values` to an array that may be empty so far because nothing before had values:
// `filler` stands for those, and for a primitive without any.
template <class T>
void appendOptional(std::vector<T>& array, const std::vector<T>& values, std::size_t before,
                    std::size_t count, const T& filler)
{
    if (array.empty() && values.empty())
        return;
    array.resize(before, filler);
    array.insert(array.end(), values.begin(), values.end());
    array.resize(before + count, filler);
}

Result<void> appendPrimitive(const GltfPrimitive& primitive, const dmat4& target,
                             const std::vector<dmat4>& joints, std::uint32_t material,
                             MeshAsset& mesh)
{
    const std::size_t count = primitive.positions.size();
    if (mesh.positions.size() + count > kMaxMeshVertices ||
        (mesh.indices.size() + primitive.indices.size()) / 3 > kMaxMeshTriangles)
        return Error{fmt::format("the scene, its instances counted, has more than {} vertices or "
                                 "{} triangles; simplify it, or bake with --per-node",
                                 kMaxMeshVertices, kMaxMeshTriangles)};
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    bool mirrored = false;
    for (std::size_t i = 0; i < count; ++i) {
        const auto transform = joints.empty() ? target : blendJoints(primitive, i, joints, target);
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
    appendOptional(mesh.texcoords0, primitive.texcoords[0], base, count, vec2{0});
    appendOptional(mesh.texcoords1, primitive.texcoords[1], base, count, vec2{0});
    appendOptional(mesh.colors, primitive.colors, base, count, VertexColor{255, 255, 255, 255});
    mesh.submeshes.push_back({static_cast<std::uint32_t>(mesh.indices.size()),
                              static_cast<std::uint32_t>(primitive.indices.size()), base,
                              static_cast<std::uint32_t>(count), material});
    for (std::size_t t = 0; t < primitive.indices.size(); t += 3) {
        mesh.indices.push_back(base + primitive.indices[t]);
        mesh.indices.push_back(base + primitive.indices[t + (mirrored ? 2 : 1)]);
        mesh.indices.push_back(base + primitive.indices[t + (mirrored ? 1 : 2)]);
    }
    return {};
}

} // namespace

GltfMeshes::GltfMeshes(const GltfDocument& document, std::vector<std::string>& warnings)
    : m_document(document), m_worldFromNode(worldFromNodes(document.model)),
      m_usedMaterials(document.model.materials.size() + 1, false), m_warnings(warnings)
{}

Result<void> GltfMeshes::append(std::size_t nodeIndex, const std::vector<dmat4>& targetFromMesh,
                                MeshAsset& out)
{
    const tinygltf::Model& model = m_document.model;
    const tinygltf::Node& node = model.nodes[nodeIndex];
    if (node.mesh == -1)
        return {};
    const tinygltf::Mesh& mesh = model.meshes[static_cast<std::size_t>(node.mesh)];
    const std::vector<double>& morphWeights = node.weights.empty() ? mesh.weights : node.weights;
    const auto joints = readJoints(node);
    if (!joints)
        return joints.error();
    for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
        const tinygltf::Primitive& primitive = mesh.primitives[p];
        if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
            warnOnce("points and lines are not read");
            continue;
        }
        if (!primitive.targets.empty())
            warnOnce("morph targets are baked with their default weights");
        const std::string place = fmt::format("meshes[{}].primitives[{}]", node.mesh, p);
        const auto read = readPrimitive(model, primitive, morphWeights);
        if (!read)
            return fail(read.error(), place);
        if (read->mendedTexcoords)
            warnOnce("texture coordinates that are not numbers, or absurd, became 0");
        const std::size_t material = primitive.material == -1
                                         ? model.materials.size()
                                         : static_cast<std::size_t>(primitive.material);
        m_usedMaterials[material] = true;
        for (const dmat4& target : targetFromMesh)
            if (const auto added = appendPrimitive(*read, target, *joints,
                                                   static_cast<std::uint32_t>(material), out);
                !added)
                return fail(added.error(), place);
    }
    return {};
}

void GltfMeshes::warnOnce(const char* text)
{
    if (std::find(m_warnings.begin(), m_warnings.end(), text) == m_warnings.end())
        m_warnings.emplace_back(text);
}

// World from bind space, per joint of the node's skin; none without a skin.
Result<std::vector<dmat4>> GltfMeshes::readJoints(const tinygltf::Node& node)
{
    std::vector<dmat4> joints;
    if (node.skin == -1)
        return joints;
    warnOnce("skins are baked in the pose that the file stores");
    const tinygltf::Skin& skin = m_document.model.skins[static_cast<std::size_t>(node.skin)];
    std::vector<float> inverseBind;
    if (skin.inverseBindMatrices != -1) {
        auto read = readFloats(m_document.model, skin.inverseBindMatrices, TINYGLTF_TYPE_MAT4);
        if (!read)
            return read.error();
        inverseBind = std::move(*read);
    }
    for (std::size_t j = 0; j < skin.joints.size(); ++j) {
        const dmat4 bind =
            inverseBind.empty() ? dmat4(1.0) : dmat4(glm::make_mat4(&inverseBind[16 * j]));
        joints.push_back(m_worldFromNode[static_cast<std::size_t>(skin.joints[j])] * bind);
    }
    return joints;
}

} // namespace penumbra
