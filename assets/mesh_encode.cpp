#include "assets/checksum.h"
#include "assets/draco_mesh.h"
#include "assets/field_payload.h"
#include "assets/glb.h"
#include "assets/mesh_codec.h"
#include "assets/mesh_format.h"

#include <cstring>
#include <nlohmann/json.hpp>

namespace penumbra {

namespace {

using nlohmann::json;

// glTF enumerators
constexpr int kUnsignedByte = 5121, kUnsignedInt = 5125, kFloat = 5126;

json vectorJson(vec3 v)
{
    return {v.x, v.y, v.z};
}

// A bufferView over `part`, appended to `bin` at a multiple of 4.
int addBufferView(json& document, std::vector<std::byte>& bin, std::span<const std::byte> part)
{
    bin.resize((bin.size() + 3) & ~std::size_t{3});
    document["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", part.size()}});
    bin.insert(bin.end(), part.begin(), part.end());
    return static_cast<int>(document["bufferViews"].size()) - 1;
}

json materialJson(const MeshMaterial& material)
{
    // Other viewers see the Phong lobe as GGX of equal width: alpha² = 2 / (exponent + 2) (Walter
    // et al. 2007, section 5.2), roughness = sqrt(alpha).
    const float roughness =
        material.glossFraction > 0 ? std::pow(2 / (material.glossExponent + 2), 0.25f) : 1.0f;
    json result = {
        {"pbrMetallicRoughness",
         {{"baseColorFactor", {material.albedo.r, material.albedo.g, material.albedo.b, 1}},
          {"metallicFactor", 0},
          {"roughnessFactor", roughness}}}};
    if (material.glossFraction > 0)
        result["extensions"][kFieldExtension] = {{"glossFraction", material.glossFraction},
                                                 {"glossExponent", material.glossExponent}};
    return result;
}

json errorsJson(const FieldErrors& errors)
{
    const auto pair = [](const FieldError& error) {
        return json{{"rms", error.rms}, {"max", error.max}};
    };
    return {{"points", errors.points},
            {"total", pair(errors.total)},
            {"angular", pair(errors.angular)},
            {"radial", pair(errors.radial)},
            {"quantisation", pair(errors.quantisation)},
            {"directions", pair(errors.directions)},
            {"bandLimit", pair(errors.bandLimit)}};
}

json fieldJson(const ShadowField& field)
{
    json result = {{"kind", field.kind == FieldKind::Occlusion ? "occlusion" : "radiance"},
                   {"basis", "sh4"},
                   {"center", vectorJson(field.center)},
                   {"radius", field.radius},
                   {"innerRadius", field.innerRadius},
                   {"outerRadius", field.outerRadius},
                   {"shellSides", field.shellSides},
                   {"bandScale", field.bandScale},
                   {"channels", field.channels},
                   {"frames", field.frames},
                   {"directions", field.directions},
                   {"encoding", kFieldEncoding},
                   {"byteLength", field.texels.size()}};
    if (field.errors)
        result["errors"] = errorsJson(*field.errors);
    return result;
}

// Accessors of the Draco attributes, which have no bufferView of their own, and the primitive that
// names them.
json primitiveJson(json& document, const MeshAsset& shipped, int dracoView)
{
    const auto addAccessor = [&](int componentType, const char* type, std::size_t count) {
        document["accessors"].push_back(
            {{"componentType", componentType}, {"type", type}, {"count", count}});
        return static_cast<int>(document["accessors"].size()) - 1;
    };
    const std::size_t vertexCount = shipped.positions.size();
    json attributes;
    json dracoAttributes = {{"POSITION", kDracoPosition}, {"NORMAL", kDracoNormal}};
    attributes["POSITION"] = addAccessor(kFloat, "VEC3", vertexCount);
    document["accessors"].back()["min"] = vectorJson(shipped.boundsMin);
    document["accessors"].back()["max"] = vectorJson(shipped.boundsMax);
    attributes["NORMAL"] = addAccessor(kFloat, "VEC3", vertexCount);
    for (std::uint32_t part = 0; part < 4; ++part) {
        attributes[kSelfVisibilityNames[part]] = addAccessor(kUnsignedByte, "VEC4", vertexCount);
        document["accessors"].back()["normalized"] = true;
        dracoAttributes[kSelfVisibilityNames[part]] = kDracoSelfVisibility0 + part;
    }
    const int indices = addAccessor(kUnsignedInt, "SCALAR", shipped.indices.size());
    return {{"attributes", attributes},
            {"indices", indices},
            {"material", 0},
            {"mode", 4},
            {"extensions",
             {{kDracoExtension, {{"bufferView", dracoView}, {"attributes", dracoAttributes}}}}}};
}

Result<void> checkOptions(const MeshEncodeOptions& options)
{
    if (options.positionBits < 8 || options.positionBits > 24 || options.normalBits < 6 ||
        options.normalBits > 16)
        return Error{
            fmt::format("{} bits of position and {} of normal, allowed 8 to 24 and 6 to 16",
                        options.positionBits, options.normalBits)};
    return {};
}

// Positions and normals as a reader will see them.
Result<void> readBack(MeshAsset& mesh, std::span<const std::byte> draco)
{
    const Result<DracoMesh> decoded = DracoMesh::decode(draco);
    if (!decoded)
        return decoded.error();
    const auto positions = decoded->floats(kDracoPosition, 3);
    const auto normals = decoded->floats(kDracoNormal, 3);
    PENUMBRA_ASSERT(positions && normals && positions->size() == 3 * mesh.positions.size(),
                    "Draco does not read what it wrote");
    std::memcpy(mesh.positions.data(), positions->data(), positions->size() * sizeof(float));
    for (std::size_t i = 0; i < mesh.normals.size(); ++i)
        mesh.normals[i] =
            normalize(vec3{(*normals)[3 * i], (*normals)[3 * i + 1], (*normals)[3 * i + 2]});
    updateDerived(mesh);
    return {};
}

} // namespace

Result<void> quantizeMesh(MeshAsset& mesh, const MeshEncodeOptions& options)
{
    if (const auto checked = checkOptions(options); !checked)
        return checked;
    const bool baked = !mesh.selfVisibility.empty();
    if (!baked)
        mesh.selfVisibility.resize(mesh.positions.size());
    const auto draco = encodeDraco(mesh, options);
    if (!baked)
        mesh.selfVisibility.clear();
    if (!draco)
        return draco.error();
    return readBack(mesh, *draco);
}

Result<std::vector<std::byte>> encodeMeshAsset(const MeshAsset& mesh,
                                               const MeshEncodeOptions& options)
{
    if (const auto checked = checkOptions(options); !checked)
        return checked.error();
    if (const auto valid = validateMesh(mesh); !valid)
        return valid.error();
    const auto draco = encodeDraco(mesh, options);
    if (!draco)
        return draco.error();
    MeshAsset shipped{
        .positions = mesh.positions, .normals = mesh.normals, .indices = mesh.indices};
    if (const auto read = readBack(shipped, *draco); !read)
        return read.error();

    json document;
    std::vector<std::byte> bin;
    document["asset"] = {{"version", "2.0"}, {"generator", "Penumbra assetc"}};
    document["extensionsUsed"] = {kDracoExtension, kFieldExtension};
    document["extensionsRequired"] = json::array({kDracoExtension});
    document["scene"] = 0;
    document["scenes"] = json::array({{{"nodes", {0}}}});
    document["nodes"] = json::array({{{"mesh", 0}, {"name", mesh.name}}});
    document["materials"] = json::array({materialJson(mesh.material)});

    const int dracoView = addBufferView(document, bin, *draco);
    json extension = mesh.field ? fieldJson(*mesh.field) : json::object();
    extension["version"] = kFormatVersion;
    extension["selfVisibilityScale"] = kSelfVisibilityScale;
    extension["geometryChecksum"] = checksumText(*draco);
    if (mesh.field) {
        const std::vector<std::byte> texels = encodeFieldTexels(*mesh.field);
        extension["fieldChecksum"] = checksumText(texels);
        extension["bufferView"] = addBufferView(document, bin, texels);
    }
    const json primitive = primitiveJson(document, shipped, dracoView);
    document["meshes"] = json::array({{{"name", mesh.name},
                                       {"primitives", json::array({primitive})},
                                       {"extensions", {{kFieldExtension, extension}}}}});
    document["buffers"] = json::array({{{"byteLength", bin.size()}}});
    // A name that is not UTF-8 gets replacement characters.
    return writeGlb(document.dump(-1, ' ', false, json::error_handler_t::replace), bin);
}

} // namespace penumbra
