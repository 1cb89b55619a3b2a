#include "assetc/import/gltf_nodes.h"

#include "assetc/import/gltf_accessor.h"
#include "assets/light_json.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

namespace penumbra {

namespace {

using glm::dmat3, glm::dmat4, glm::dquat, glm::dvec3;

constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";

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

} // namespace

std::vector<int> parentsOfNodes(const tinygltf::Model& model)
{
    std::vector<int> parents(model.nodes.size(), -1);
    for (std::size_t i = 0; i < model.nodes.size(); ++i)
        for (const int child : model.nodes[i].children)
            parents[static_cast<std::size_t>(child)] = static_cast<int>(i);
    return parents;
}

// Nodes form a forest (checkModel), so the walk ends.
std::vector<dmat4> worldFromNodes(const tinygltf::Model& model)
{
    std::vector<dmat4> world(model.nodes.size(), dmat4(1.0));
    const std::vector<int> parents = parentsOfNodes(model);
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < model.nodes.size(); ++i)
        if (parents[i] == -1) {
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

bool hasInstances(const GltfDocument& document, std::size_t node)
{
    JsonProblems ignored;
    const JsonReader source =
        JsonReader(document.json, "gltf", ignored).member("nodes").element(node);
    return source.has("extensions") && source.member("extensions").has(kInstancing);
}

Result<std::vector<dmat4>> nodeFromInstances(const GltfDocument& document, std::size_t node)
{
    if (!hasInstances(document, node))
        return std::vector<dmat4>{dmat4(1.0)};
    JsonProblems problems;
    const JsonReader attributes = JsonReader(document.json, "gltf", problems)
                                      .member("nodes")
                                      .element(node)
                                      .member("extensions")
                                      .member(kInstancing)
                                      .member("attributes");
    std::size_t count = 0;
    std::string first;
    const auto read = [&](const char* name, int type) -> Result<std::vector<float>> {
        if (!attributes.has(name))
            return std::vector<float>{};
        const std::uint64_t index = attributes.count(name, kMaxGltfElements);
        if (!problems.empty())
            return problems.front();
        if (index >= document.model.accessors.size())
            return Error{fmt::format("{} of {}: no accessor {}", name, kInstancing, index)};
        const std::size_t elements = document.model.accessors[index].count;
        if (elements > kMaxInstances)
            return Error{fmt::format("{} of {}: {} instances, more than {}; export fewer to a file",
                                     name, kInstancing, elements, kMaxInstances)};
        if (!first.empty() && elements != count)
            return Error{fmt::format("{} of {}: {} elements, {} has {}", name, kInstancing,
                                     elements, first, count)};
        count = elements;
        first = name;
        return readFloats(document.model, static_cast<int>(index), type);
    };
    const auto translations = read("TRANSLATION", TINYGLTF_TYPE_VEC3);
    const auto rotations =
        translations ? read("ROTATION", TINYGLTF_TYPE_VEC4) : translations.error();
    const auto scales = rotations ? read("SCALE", TINYGLTF_TYPE_VEC3) : rotations.error();
    if (!problems.empty())
        return problems.front();
    if (!scales)
        return fail(scales.error(), fmt::format("nodes[{}]", node));
    if (count == 0)
        return Error{
            fmt::format("nodes[{}]: {} without TRANSLATION, ROTATION or SCALE", node, kInstancing)};
    std::vector<dmat4> instances(count, dmat4(1.0));
    for (std::size_t i = 0; i < count; ++i) {
        if (!translations->empty())
            instances[i] =
                glm::translate(instances[i], dvec3(glm::make_vec3(&(*translations)[3 * i])));
        if (!rotations->empty()) {
            const float* q = &(*rotations)[4 * i];
            const dquat turn(q[3], q[0], q[1], q[2]);
            if (!(glm::length(turn) > 0.1)) // normalised bytes are some percent off
                return Error{fmt::format("nodes[{}]: instance {} has no rotation", node, i)};
            instances[i] *= glm::mat4_cast(glm::normalize(turn));
        }
        if (!scales->empty())
            instances[i] = glm::scale(instances[i], dvec3(glm::make_vec3(&(*scales)[3 * i])));
    }
    return instances;
}

Result<std::vector<PlacedLight>> lightsOfNodes(const GltfDocument& document,
                                               const std::vector<dmat4>& worldFromNode)
{
    std::vector<PlacedLight> placed;
    JsonProblems problems;
    const JsonReader root(document.json, "gltf", problems);
    const std::vector<MeshLight> lights = readLights(root);
    if (!problems.empty())
        return problems.front();
    if (!root.has("nodes"))
        return placed;
    const JsonReader nodes = root.member("nodes");
    for (const std::size_t node : sceneNodes(document.model)) {
        const auto index = lightOfNode(nodes.element(node), lights.size());
        if (!problems.empty())
            return problems.front();
        if (!index)
            continue;
        if (placed.size() == kMaxMeshLights)
            return Error{fmt::format("nodes[{}]: more than {} lights", node, kMaxMeshLights)};
        MeshLight light = lights[*index];
        if (light.name.empty())
            light.name = document.model.nodes[node].name.substr(0, kMaxNameBytes);
        const dmat4& world = worldFromNode[node];
        light.position = vec3(world[3]);
        const dvec3 direction = dmat3(world) * dvec3(0, 0, -1);
        const double size = glm::length(direction);
        light.direction = size > 0 ? vec3(direction / size) : vec3(0, 0, -1);
        if (!(glm::length(world[3]) <= kMaxCoordinate) || !std::isfinite(size))
            return Error{fmt::format("nodes[{}]: a light beyond {} m", node, kMaxCoordinate)};
        placed.push_back({light, node});
    }
    return placed;
}

} // namespace penumbra
