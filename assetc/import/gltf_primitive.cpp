#include "assetc/import/gltf_primitive.h"

#include "assetc/import/gltf_accessor.h"
#include "assets/draco_mesh.h"

#include <algorithm>
#include <numeric>

namespace penumbra {

namespace {

// Attributes from accessors, or from a Draco payload where the primitive has one.
class AttributeSource {
public:
    static Result<AttributeSource> open(const tinygltf::Model& model,
                                        const tinygltf::Primitive& primitive)
    {
        AttributeSource source(model, primitive);
        if (const auto found = primitive.extensions.find("KHR_draco_mesh_compression");
            found != primitive.extensions.end())
            if (const auto opened = source.openDraco(found->second); !opened)
                return opened.error();
        return source;
    }

    [[nodiscard]] bool has(const char* name) const
    {
        return m_primitive->attributes.contains(name);
    }

    [[nodiscard]] Result<std::vector<float>> read(const char* name, int type) const
    {
        if (m_draco && m_dracoIds.Has(name))
            return readDraco(name, type);
        return readFloats(*m_model, m_primitive->attributes.at(name), type);
    }

    // TINYGLTF_TYPE_… that the accessor says.
    [[nodiscard]] int typeOf(const char* name) const { return accessorOf(name).type; }

    [[nodiscard]] Result<std::vector<std::uint32_t>> indices(std::size_t vertexCount) const
    {
        if (m_draco)
            return m_draco->indices();
        if (m_primitive->indices != -1)
            return readIndices(*m_model, m_primitive->indices);
        std::vector<std::uint32_t> all(vertexCount);
        std::iota(all.begin(), all.end(), 0u);
        return all;
    }

    [[nodiscard]] bool isDraco() const { return m_draco != nullptr; }

private:
    AttributeSource(const tinygltf::Model& model, const tinygltf::Primitive& primitive)
        : m_model(&model), m_primitive(&primitive)
    {}

    [[nodiscard]] const tinygltf::Accessor& accessorOf(const char* name) const
    {
        return m_model->accessors[static_cast<std::size_t>(m_primitive->attributes.at(name))];
    }

    // Exporters forget to mark integers as normalised in the payload: the accessor counts.
    [[nodiscard]] Result<std::vector<float>> readDraco(const char* name, int type) const
    {
        const auto id = static_cast<std::uint32_t>(m_dracoIds.Get(name).GetNumberAsInt());
        auto values =
            m_draco->floats(id, tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type)));
        const tinygltf::Accessor& accessor = accessorOf(name);
        const float largest = accessor.componentType == TINYGLTF_COMPONENT_TYPE_BYTE    ? 127.0f
                              : accessor.componentType == TINYGLTF_COMPONENT_TYPE_SHORT ? 32767.0f
                              : accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE
                                  ? 255.0f
                                  : 65535.0f;
        if (values && accessor.normalized && !m_draco->normalized(id))
            for (float& value : *values)
                value /= largest;
        return values;
    }

    Result<void> openDraco(const tinygltf::Value& extension)
    {
        const int view = extension.Has("bufferView") && extension.Get("bufferView").IsInt()
                             ? extension.Get("bufferView").GetNumberAsInt()
                             : -1;
        if (view < 0 || static_cast<std::size_t>(view) >= m_model->bufferViews.size() ||
            !extension.Has("attributes") || !extension.Get("attributes").IsObject())
            return Error{fmt::format(
                "KHR_draco_mesh_compression: no bufferView {}, or no attributes", view)};
        m_dracoIds = extension.Get("attributes");
        for (const std::string& name : m_dracoIds.Keys())
            if (!m_dracoIds.Get(name).IsInt())
                return Error{fmt::format(
                    "KHR_draco_mesh_compression: the id of attribute {} is no whole number", name)};
        const tinygltf::BufferView& source = m_model->bufferViews[static_cast<std::size_t>(view)];
        const auto& data = m_model->buffers[static_cast<std::size_t>(source.buffer)].data;
        auto decoded = DracoMesh::decode(
            std::as_bytes(std::span(data)).subspan(source.byteOffset, source.byteLength));
        if (!decoded)
            return decoded.error();
        m_draco = std::make_shared<DracoMesh>(std::move(*decoded));
        return {};
    }

    const tinygltf::Model* m_model;
    const tinygltf::Primitive* m_primitive;
    std::shared_ptr<const DracoMesh> m_draco;
    tinygltf::Value m_dracoIds;
};

vec3 vectorAt(const std::vector<float>& values, std::size_t i)
{
    return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

Result<std::vector<vec3>> readVectors(const AttributeSource& source, const char* name)
{
    const auto values = source.read(name, TINYGLTF_TYPE_VEC3);
    if (!values)
        return fail(values.error(), name);
    std::vector<vec3> vectors(values->size() / 3);
    for (std::size_t i = 0; i < vectors.size(); ++i)
        vectors[i] = vectorAt(*values, i);
    return vectors;
}

Result<void> applyMorph(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                        const std::vector<double>& weights, const char* name,
                        std::vector<vec3>& target)
{
    for (std::size_t t = 0; t < std::min(weights.size(), primitive.targets.size()); ++t) {
        const auto found = primitive.targets[t].find(name);
        if (weights[t] == 0 || found == primitive.targets[t].end())
            continue;
        const auto offsets = readFloats(model, found->second, TINYGLTF_TYPE_VEC3);
        if (!offsets)
            return fail(offsets.error(), "morph target");
        if (offsets->size() != 3 * target.size())
            return Error{fmt::format("morph target {} has {} vertices of {}", t,
                                     offsets->size() / 3, target.size())};
        for (std::size_t i = 0; i < target.size(); ++i)
            target[i] += static_cast<float>(weights[t]) * vectorAt(*offsets, i);
    }
    return {};
}

Result<void> readSkinning(const AttributeSource& source, std::size_t vertexCount,
                          GltfPrimitive& out)
{
    if (!source.has("JOINTS_0") || !source.has("WEIGHTS_0"))
        return {};
    const auto joints = source.read("JOINTS_0", TINYGLTF_TYPE_VEC4);
    if (!joints)
        return fail(joints.error(), "JOINTS_0");
    const auto weights = source.read("WEIGHTS_0", TINYGLTF_TYPE_VEC4);
    if (!weights)
        return fail(weights.error(), "WEIGHTS_0");
    if (joints->size() != 4 * vertexCount || weights->size() != 4 * vertexCount)
        return Error{"JOINTS_0 or WEIGHTS_0 has another count than POSITION"};
    for (std::size_t i = 0; i < vertexCount; ++i) {
        glm::uvec4 joint{0};
        vec4 weight{0};
        for (int k = 0; k < 4; ++k) {
            const std::size_t at = 4 * i + static_cast<std::size_t>(k);
            const float id = (*joints)[at];
            joint[k] = id >= 0 && id < 65536.0f ? static_cast<std::uint32_t>(id)
                                                : 65536u; // checked against the skin
            weight[k] = (*weights)[at];
        }
        const float sum =
            weight.x + weight.y + weight.z + weight.w; // real files have sums beside 1
        out.joints.push_back(joint);
        out.weights.push_back(sum > 1e-6f ? weight / sum : vec4{0});
    }
    return {};
}

Result<void> readTexcoords(const AttributeSource& source, const char* name,
                           std::vector<vec2>& texcoords, GltfPrimitive& out)
{
    if (!source.has(name))
        return {};
    const auto values = source.read(name, TINYGLTF_TYPE_VEC2);
    if (!values)
        return fail(values.error(), name);
    if (values->size() != 2 * out.positions.size())
        return Error{fmt::format("{} has another count than POSITION", name)};
    for (std::size_t i = 0; i < values->size(); i += 2) {
        const vec2 uv((*values)[i], (*values)[i + 1]);
        const bool good = abs(uv.x) <= kMaxTextureNumber && abs(uv.y) <= kMaxTextureNumber;
        texcoords.push_back(good ? uv : vec2{0});
        out.mendedTexcoords = out.mendedTexcoords || !good;
    }
    return {};
}

Result<void> readColors(const AttributeSource& source, GltfPrimitive& out)
{
    if (!source.has("COLOR_0"))
        return {};
    const int type =
        source.typeOf("COLOR_0") == TINYGLTF_TYPE_VEC3 ? TINYGLTF_TYPE_VEC3 : TINYGLTF_TYPE_VEC4;
    const auto values = source.read("COLOR_0", type);
    if (!values)
        return fail(values.error(), "COLOR_0");
    const std::size_t components = type == TINYGLTF_TYPE_VEC3 ? 3 : 4;
    if (values->size() != components * out.positions.size())
        return Error{"COLOR_0 has another count than POSITION"};
    out.colors.assign(out.positions.size(), {255, 255, 255, 255});
    for (std::size_t i = 0; i < values->size(); ++i) {
        const float value = (*values)[i];
        out.colors[i / components][i % components] = static_cast<std::uint8_t>(
            value > 0 ? min(value, 1.0f) * 255.0f + 0.5f : 0.0f); // NaN is 0
    }
    return {};
}

// Strips and fans as lists; corners beyond whole triangles are dropped. Strips turn every other
// triangle around.
std::vector<std::uint32_t> toTriangleList(const std::vector<std::uint32_t>& in, int mode)
{
    if (mode == TINYGLTF_MODE_TRIANGLES)
        return {in.begin(), in.end() - static_cast<std::ptrdiff_t>(in.size() % 3)};
    std::vector<std::uint32_t> out;
    for (std::size_t i = 2; i < in.size(); ++i) {
        if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
            out.insert(out.end(), {in[0], in[i - 1], in[i]});
        else if (i % 2 == 0)
            out.insert(out.end(), {in[i - 2], in[i - 1], in[i]});
        else
            out.insert(out.end(), {in[i - 1], in[i - 2], in[i]});
    }
    return out;
}

} // namespace

Result<GltfPrimitive> readPrimitive(const tinygltf::Model& model,
                                    const tinygltf::Primitive& primitive,
                                    const std::vector<double>& weights)
{
    const auto source = AttributeSource::open(model, primitive);
    if (!source)
        return source.error();
    if (!source->has("POSITION"))
        return Error{"no POSITION"};
    GltfPrimitive out;
    auto positions = readVectors(*source, "POSITION");
    if (!positions)
        return positions.error();
    out.positions = std::move(*positions);
    const std::size_t vertexCount = out.positions.size();
    if (vertexCount > kMaxMeshVertices)
        return Error{fmt::format("{} vertices, more than {}", vertexCount, kMaxMeshVertices)};

    out.normals.assign(vertexCount, vec3{0});
    if (source->has("NORMAL")) {
        auto normals = readVectors(*source, "NORMAL");
        if (!normals)
            return normals.error();
        if (normals->size() != vertexCount)
            return Error{fmt::format("{} normals for {} positions", normals->size(), vertexCount)};
        out.normals = std::move(*normals);
        if (const auto morphed = applyMorph(model, primitive, weights, "NORMAL", out.normals);
            !morphed)
            return morphed.error();
    }
    if (const auto morphed = applyMorph(model, primitive, weights, "POSITION", out.positions);
        !morphed)
        return morphed.error();
    if (const auto skinning = readSkinning(*source, vertexCount, out); !skinning)
        return skinning.error();

    for (const Result<void>& read :
         {readTexcoords(*source, "TEXCOORD_0", out.texcoords[0], out),
          readTexcoords(*source, "TEXCOORD_1", out.texcoords[1], out), readColors(*source, out)})
        if (!read)
            return read.error();

    const auto indices = source->indices(vertexCount);
    if (!indices)
        return indices.error();
    for (std::size_t i = 0; i < indices->size(); ++i)
        if ((*indices)[i] >= vertexCount)
            return Error{fmt::format("index {} is vertex {} of {}", i, (*indices)[i], vertexCount)};
    out.indices =
        toTriangleList(*indices, source->isDraco() ? TINYGLTF_MODE_TRIANGLES : primitive.mode);
    return out;
}

} // namespace penumbra
