#include "assetc/import/gltf_check.h"

#include "assetc/import/gltf_accessor.h"
#include "assets/mesh_asset.h"

namespace penumbra {

namespace {

template <class T>
bool isIndex(int index, const std::vector<T>& of)
{
    return index >= 0 && static_cast<std::size_t>(index) < of.size();
}

Error bad(const char* what, std::size_t index, const std::string& problem)
{
    return {fmt::format("{}[{}]: {}", what, index, problem)};
}

// Whether `count` elements of `size` bytes, `stride` apart from `offset` on, lie in a bufferView.
// No product can overflow: counts and strides are bounded by the callers, offsets by the
// comparison.
bool fits(const tinygltf::BufferView& view, std::uint64_t offset, std::uint64_t count,
          std::uint64_t stride, std::uint64_t size)
{
    return offset <= view.byteLength && (count - 1) * stride + size <= view.byteLength - offset;
}

Result<void> checkBufferViews(const tinygltf::Model& model)
{
    for (std::size_t i = 0; i < model.bufferViews.size(); ++i) {
        const tinygltf::BufferView& view = model.bufferViews[i];
        if (!isIndex(view.buffer, model.buffers))
            return bad("bufferViews", i, fmt::format("no buffer {}", view.buffer));
        const std::size_t size = model.buffers[static_cast<std::size_t>(view.buffer)].data.size();
        if (view.byteOffset > size || view.byteLength > size - view.byteOffset)
            return bad("bufferViews", i,
                       fmt::format("{} bytes from {} in a buffer of {}", view.byteLength,
                                   view.byteOffset, size));
        if (view.byteStride != 0 && (view.byteStride < 4 || view.byteStride > 252))
            return bad("bufferViews", i, fmt::format("stride {}", view.byteStride));
    }
    return {};
}

Result<void> checkSparse(const tinygltf::Model& model, const tinygltf::Accessor& accessor,
                         std::size_t i)
{
    const auto& sparse = accessor.sparse;
    if (sparse.count < 1 || static_cast<std::size_t>(sparse.count) > accessor.count)
        return bad("accessors", i,
                   fmt::format("{} sparse values for {} elements", sparse.count, accessor.count));
    if (!isIndex(sparse.indices.bufferView, model.bufferViews) ||
        !isIndex(sparse.values.bufferView, model.bufferViews))
        return bad("accessors", i, "sparse part in a bufferView that does not exist");
    const int type = sparse.indices.componentType;
    if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
        type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
        type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
        return bad("accessors", i, fmt::format("sparse indices of component type {}", type));
    const auto count = static_cast<std::uint64_t>(sparse.count);
    const auto width = static_cast<std::uint64_t>(componentBytes(type));
    const std::uint64_t size = elementBytes(accessor);
    const auto& indexView = model.bufferViews[static_cast<std::size_t>(sparse.indices.bufferView)];
    const auto& valueView = model.bufferViews[static_cast<std::size_t>(sparse.values.bufferView)];
    if (sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0 ||
        !fits(indexView, static_cast<std::uint64_t>(sparse.indices.byteOffset), count, width,
              width) ||
        !fits(valueView, static_cast<std::uint64_t>(sparse.values.byteOffset), count, size, size))
        return bad("accessors", i, "sparse part reaches beyond its bufferView");
    for (const std::uint32_t index : sparseIndices(model, accessor))
        if (index >= accessor.count)
            return bad("accessors", i,
                       fmt::format("sparse index {} of {} elements", index, accessor.count));
    return {};
}

Result<void> checkAccessors(const tinygltf::Model& model)
{
    for (std::size_t i = 0; i < model.accessors.size(); ++i) {
        const tinygltf::Accessor& accessor = model.accessors[i];
        if (componentBytes(accessor.componentType) == 0 ||
            tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)) < 1)
            return bad("accessors", i, fmt::format("component type {}", accessor.componentType));
        if (accessor.count < 1 || accessor.count > 3ull * kMaxMeshTriangles)
            return bad(
                "accessors", i,
                fmt::format("{} elements, allowed 1 to {}", accessor.count, 3 * kMaxMeshTriangles));
        if (accessor.bufferView != -1) {
            if (!isIndex(accessor.bufferView, model.bufferViews))
                return bad("accessors", i, fmt::format("no bufferView {}", accessor.bufferView));
            const tinygltf::BufferView& view =
                model.bufferViews[static_cast<std::size_t>(accessor.bufferView)];
            const std::uint64_t size = elementBytes(accessor);
            const std::uint64_t stride = view.byteStride == 0 ? size : view.byteStride;
            if (stride < size)
                return bad("accessors", i,
                           fmt::format("elements of {} bytes, {} apart", size, stride));
            if (!fits(view, accessor.byteOffset, accessor.count, stride, size))
                return bad("accessors", i,
                           fmt::format("{} elements reach beyond the {} bytes of bufferView {}",
                                       accessor.count, view.byteLength, accessor.bufferView));
        }
        if (accessor.sparse.isSparse)
            if (const auto sparse = checkSparse(model, accessor, i); !sparse)
                return sparse;
    }
    return {};
}

Result<void> checkPrimitive(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                            std::size_t mesh)
{
    const auto checkAttributes = [&](const std::map<std::string, int>& attributes) -> Result<void> {
        for (const auto& [name, accessor] : attributes)
            if (!isIndex(accessor, model.accessors))
                return bad("meshes", mesh, fmt::format("{}: no accessor {}", name, accessor));
        return {};
    };
    if (primitive.mode < TINYGLTF_MODE_POINTS || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
        return bad("meshes", mesh, fmt::format("mode {}", primitive.mode));
    if (primitive.indices != -1 && !isIndex(primitive.indices, model.accessors))
        return bad("meshes", mesh, fmt::format("indices: no accessor {}", primitive.indices));
    if (primitive.material != -1 && !isIndex(primitive.material, model.materials))
        return bad("meshes", mesh, fmt::format("no material {}", primitive.material));
    for (const auto& target : primitive.targets)
        if (const auto checked = checkAttributes(target); !checked)
            return checked;
    return checkAttributes(primitive.attributes);
}

bool isSize(const std::vector<double>& values, std::size_t size)
{
    return values.empty() || values.size() == size;
}

Result<void> checkNodes(const tinygltf::Model& model)
{
    const std::size_t count = model.nodes.size();
    std::vector<int> parents(count, -1);
    for (std::size_t i = 0; i < count; ++i) {
        const tinygltf::Node& node = model.nodes[i];
        if (node.mesh != -1 && !isIndex(node.mesh, model.meshes))
            return bad("nodes", i, fmt::format("no mesh {}", node.mesh));
        if (node.skin != -1 && !isIndex(node.skin, model.skins))
            return bad("nodes", i, fmt::format("no skin {}", node.skin));
        if (!isSize(node.matrix, 16) || !isSize(node.rotation, 4) || !isSize(node.scale, 3) ||
            !isSize(node.translation, 3))
            return bad("nodes", i, "matrix, rotation, scale or translation of a wrong length");
        for (const int child : node.children) {
            if (!isIndex(child, model.nodes))
                return bad("nodes", i, fmt::format("no child node {}", child));
            if (std::exchange(parents[static_cast<std::size_t>(child)], static_cast<int>(i)) != -1)
                return bad("nodes", static_cast<std::size_t>(child), "has two parents");
        }
    }
    // With one parent each, a walk down from the roots meets every node but those in or below a
    // cycle.
    std::vector<int> open;
    for (std::size_t i = 0; i < count; ++i)
        if (parents[i] == -1)
            open.push_back(static_cast<int>(i));
    std::size_t met = 0;
    for (; !open.empty(); ++met) {
        const auto& children = model.nodes[static_cast<std::size_t>(open.back())].children;
        open.pop_back();
        open.insert(open.end(), children.begin(), children.end());
    }
    if (met != count)
        return Error{"nodes: a node is its own ancestor"};
    return {};
}

Result<void> checkSkins(const tinygltf::Model& model)
{
    for (std::size_t i = 0; i < model.skins.size(); ++i) {
        const tinygltf::Skin& skin = model.skins[i];
        for (const int joint : skin.joints)
            if (!isIndex(joint, model.nodes))
                return bad("skins", i, fmt::format("no joint node {}", joint));
        if (skin.inverseBindMatrices == -1)
            continue;
        if (!isIndex(skin.inverseBindMatrices, model.accessors))
            return bad("skins", i, fmt::format("no accessor {}", skin.inverseBindMatrices));
        const auto& accessor = model.accessors[static_cast<std::size_t>(skin.inverseBindMatrices)];
        if (accessor.type != TINYGLTF_TYPE_MAT4 ||
            accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT ||
            accessor.count < skin.joints.size())
            return bad("skins", i, "inverse bind matrices are not one float 4x4 per joint");
    }
    return {};
}

} // namespace

Result<void> checkModel(const tinygltf::Model& model)
{
    if (const auto checked = checkBufferViews(model); !checked)
        return checked;
    if (const auto checked = checkAccessors(model); !checked)
        return checked;
    for (std::size_t i = 0; i < model.meshes.size(); ++i)
        for (const tinygltf::Primitive& primitive : model.meshes[i].primitives)
            if (const auto checked = checkPrimitive(model, primitive, i); !checked)
                return checked;
    if (const auto checked = checkNodes(model); !checked)
        return checked;
    for (std::size_t i = 0; i < model.scenes.size(); ++i)
        for (const int node : model.scenes[i].nodes)
            if (!isIndex(node, model.nodes))
                return bad("scenes", i, fmt::format("no node {}", node));
    if (model.defaultScene != -1 && !isIndex(model.defaultScene, model.scenes))
        return Error{fmt::format("scene: no scene {}", model.defaultScene)};
    return checkSkins(model);
}

} // namespace penumbra
