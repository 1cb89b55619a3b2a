#include "assetc/import/gltf_accessor.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace penumbra {

namespace {

template <class T>
double load(const unsigned char* bytes, bool normalized)
{
    T value;
    std::memcpy(&value, bytes, sizeof value);
    if (!normalized || std::numeric_limits<T>::is_iec559)
        return static_cast<double>(value);
    return std::max(static_cast<double>(value) / static_cast<double>(std::numeric_limits<T>::max()),
                    -1.0);
}

double loadComponent(const unsigned char* bytes, int componentType, bool normalized)
{
    switch (componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        return load<std::int8_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return load<std::uint8_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        return load<std::int16_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return load<std::uint16_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return load<std::uint32_t>(bytes, normalized);
    default:
        return load<float>(bytes, false);
    }
}

const unsigned char* bytesOf(const tinygltf::Model& model, int bufferView, std::size_t offset)
{
    const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(bufferView)];
    return model.buffers[static_cast<std::size_t>(view.buffer)].data.data() + view.byteOffset +
           offset;
}

template <class T>
std::vector<T> readValues(const tinygltf::Model& model, const tinygltf::Accessor& accessor)
{
    const auto components = static_cast<std::size_t>(
        tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)));
    const auto width = static_cast<std::size_t>(componentBytes(accessor.componentType));
    std::vector<T> values(accessor.count * components);
    const auto copyElement = [&](std::size_t element, const unsigned char* source) {
        for (std::size_t c = 0; c < components; ++c)
            values[element * components + c] = static_cast<T>(
                loadComponent(source + c * width, accessor.componentType, accessor.normalized));
    };
    if (accessor.bufferView != -1) {
        const std::size_t given =
            model.bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteStride;
        const std::size_t stride = given == 0 ? elementBytes(accessor) : given;
        const unsigned char* first = bytesOf(model, accessor.bufferView, accessor.byteOffset);
        for (std::size_t i = 0; i < accessor.count; ++i)
            copyElement(i, first + i * stride);
    }
    if (accessor.sparse.isSparse) {
        const unsigned char* first =
            bytesOf(model, accessor.sparse.values.bufferView,
                    static_cast<std::size_t>(accessor.sparse.values.byteOffset));
        for (const std::uint32_t index : sparseIndices(model, accessor)) {
            copyElement(index, first);
            first += elementBytes(accessor);
        }
    }
    return values;
}

} // namespace

int componentBytes(int componentType)
{
    switch (componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return 4;
    default:
        return 0;
    }
}

std::uint64_t elementBytes(const tinygltf::Accessor& accessor)
{
    // Matrices of bytes and shorts have padded columns; assetc reads only float ones, whose columns
    // have none.
    return static_cast<std::uint64_t>(componentBytes(accessor.componentType)) *
           static_cast<std::uint64_t>(
               tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)));
}

Result<std::vector<float>> readFloats(const tinygltf::Model& model, int accessor, int type)
{
    const tinygltf::Accessor& source = model.accessors[static_cast<std::size_t>(accessor)];
    if (source.type != type)
        return Error{
            fmt::format("accessors[{}]: has {} components, expected {}", accessor,
                        tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(source.type)),
                        tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type)))};
    return readValues<float>(model, source);
}

Result<std::vector<std::uint32_t>> readIndices(const tinygltf::Model& model, int accessor)
{
    const tinygltf::Accessor& source = model.accessors[static_cast<std::size_t>(accessor)];
    const bool isUnsigned = source.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                            source.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                            source.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    if (source.type != TINYGLTF_TYPE_SCALAR || !isUnsigned || source.normalized)
        return Error{fmt::format("accessors[{}]: indices are not unsigned integers", accessor)};
    return readValues<std::uint32_t>(model, source);
}

std::vector<std::uint32_t> sparseIndices(const tinygltf::Model& model,
                                         const tinygltf::Accessor& accessor)
{
    const auto& indices = accessor.sparse.indices;
    const auto width = static_cast<std::size_t>(componentBytes(indices.componentType));
    const unsigned char* first =
        bytesOf(model, indices.bufferView, static_cast<std::size_t>(indices.byteOffset));
    std::vector<std::uint32_t> values(static_cast<std::size_t>(accessor.sparse.count));
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = static_cast<std::uint32_t>(
            loadComponent(first + i * width, indices.componentType, false));
    return values;
}

} // namespace penumbra
