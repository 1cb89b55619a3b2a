#include "assets/draco_mesh.h"
#include "assets/field_payload.h"
#include "assets/glb.h"
#include "assets/json_reader.h"
#include "assets/mesh_codec.h"
#include "assets/mesh_format.h"

#include <charconv>
#include <cstring>
#include <limits>

namespace penumbra {

namespace {

constexpr std::size_t kMaxJsonBytes = 1 << 20; // our own files have less than 4 KiB
constexpr std::size_t kMaxViews = 1024;

vec3 readVec3(const JsonReader& array)
{
    vec3 value{0};
    for (int axis = 0; axis < 3; ++axis)
        value[axis] =
            array.element(static_cast<std::size_t>(axis)).asNumber(-kMaxCoordinate, kMaxCoordinate);
    return value;
}

// The bytes of a bufferView, which must lie in the BIN chunk.
std::span<const std::byte> readView(const JsonReader& root, std::uint64_t index,
                                    std::span<const std::byte> bin)
{
    const JsonReader views = root.member("bufferViews");
    if (index >= views.length(kMaxViews)) {
        views.refuse(fmt::format("has no element {}", index));
        return {};
    }
    const JsonReader view = views.element(index);
    if (view.count("buffer", kMaxViews) != 0)
        view.refuse("is not in buffer 0, the BIN chunk");
    const std::uint64_t limit = std::min<std::uint64_t>(
        bin.size(), root.member("buffers").element(0).count(
                        "byteLength", std::numeric_limits<std::uint32_t>::max()));
    const std::uint64_t offset = view.has("byteOffset") ? view.count("byteOffset", limit) : 0;
    const std::uint64_t length = view.count("byteLength", limit);
    if (length > limit - std::min(offset, limit)) {
        view.refuse(fmt::format("ends at byte {} of {}", offset + length, limit));
        return {};
    }
    return bin.subspan(offset, length);
}

void checkVersion(const JsonReader& extension)
{
    const std::string version = extension.text("version");
    int major = 0;
    const auto parsed = std::from_chars(version.data(), version.data() + version.size(), major);
    if (parsed.ec != std::errc{} || parsed.ptr == version.data() + version.size() ||
        *parsed.ptr != '.')
        extension.refuse(fmt::format("has version \"{}\", not MAJOR.MINOR", version));
    else if (major != kFormatMajor)
        extension.refuse(fmt::format(
            "has version {}, this program reads {}.x; compile the asset again with the assetc "
            "of this version",
            version, kFormatMajor));
}

ShadowField readFieldHead(const JsonReader& extension)
{
    constexpr float kAnyFloat =
        std::numeric_limits<float>::max(); // validateFieldHead has the ranges
    ShadowField field;
    const std::string kind = extension.text("kind");
    if (kind != "occlusion" && kind != "radiance")
        extension.refuse(fmt::format("has kind \"{}\", known are occlusion and radiance", kind));
    field.kind = kind == "radiance" ? FieldKind::Radiance : FieldKind::Occlusion;
    if (const std::string basis = extension.text("basis"); basis != "sh4")
        extension.refuse(fmt::format("has basis \"{}\", known is sh4", basis));
    if (const std::string encoding = extension.text("encoding"); encoding != kFieldEncoding)
        extension.refuse(fmt::format("has encoding \"{}\", known is {}", encoding, kFieldEncoding));
    field.center = readVec3(extension.member("center"));
    field.radius = extension.number("radius", 0, kAnyFloat);
    field.innerRadius = extension.number("innerRadius", 0, kAnyFloat);
    field.outerRadius = extension.number("outerRadius", 0, kAnyFloat);
    field.channels = static_cast<std::uint32_t>(extension.count("channels", 3));
    field.frames = static_cast<std::uint32_t>(extension.count("frames", kMaxFieldFrames));
    field.directions =
        static_cast<std::uint32_t>(extension.count("directions", kMaxFieldDirections));
    const JsonReader scales = extension.member("bandScale");
    for (std::size_t band = 0; band < field.bandScale.size(); ++band)
        field.bandScale[band] = scales.element(band).asNumber(0, kAnyFloat);
    const JsonReader sides = extension.member("shellSides");
    const std::size_t shells = sides.length(kMaxFieldShells);
    for (std::size_t s = 0; s < shells; ++s)
        field.shellSides.push_back(
            static_cast<std::uint16_t>(sides.element(s).asCount(kMaxFieldSide)));
    return field;
}

Result<ShadowField> readField(const JsonReader& root, const JsonReader& extension,
                              std::span<const std::byte> bin, const JsonProblem& problem)
{
    ShadowField field = readFieldHead(extension);
    const std::uint64_t byteLength = extension.count("byteLength", kMaxFieldBytes);
    const auto payload = readView(root, extension.count("bufferView", kMaxViews), bin);
    if (problem)
        return *problem;
    if (const auto head = validateFieldHead(field); !head)
        return head.error();
    if (byteLength != fieldTexelBytes(field))
        return Error{fmt::format("field: byteLength {}, the shells need {}", byteLength,
                                 fieldTexelBytes(field))};
    auto texels = decodeFieldTexels(field, payload);
    if (!texels)
        return texels.error();
    field.texels = std::move(*texels);
    return field;
}

MeshMaterial readMaterial(const JsonReader& root, const JsonReader& primitive)
{
    MeshMaterial material;
    if (!primitive.has("material"))
        return material;
    const JsonReader source =
        root.member("materials").element(primitive.count("material", kMaxViews));
    const JsonReader base = source.member("pbrMetallicRoughness").member("baseColorFactor");
    for (int channel = 0; channel < 3; ++channel)
        material.albedo[channel] = base.element(static_cast<std::size_t>(channel)).asNumber(0, 1);
    if (source.has("extensions") && source.member("extensions").has(kFieldExtension)) {
        const JsonReader gloss = source.member("extensions").member(kFieldExtension);
        material.glossFraction = gloss.number("glossFraction", 0, 1);
        material.glossExponent = gloss.number("glossExponent", 0, kMaxGlossExponent);
    }
    return material;
}

// Geometry out of the Draco payload, whose counts must be those of the accessors.
Result<void> readGeometry(const JsonReader& root, const JsonReader& primitive,
                          std::span<const std::byte> bin, const JsonProblem& problem,
                          MeshAsset& mesh)
{
    const JsonReader compressed = primitive.member("extensions").member(kDracoExtension);
    const JsonReader ids = compressed.member("attributes");
    const JsonReader attributes = primitive.member("attributes");
    const auto idOf = [&](const char* name) {
        return static_cast<std::uint32_t>(ids.count(name, kMaxViews));
    };
    const auto countOf = [&](const JsonReader& accessor) {
        return root.member("accessors")
            .element(accessor.asCount(kMaxViews))
            .count("count", kMaxMeshTriangles * 3);
    };
    const auto payload = readView(root, compressed.count("bufferView", kMaxViews), bin);
    const std::uint64_t vertexCount = countOf(attributes.member("POSITION"));
    const std::uint64_t indexCount = countOf(primitive.member("indices"));
    const std::uint32_t position = idOf("POSITION");
    const std::uint32_t normal = idOf("NORMAL");
    std::array<std::uint32_t, 4> selfVisibility{};
    for (std::size_t part = 0; part < 4; ++part)
        selfVisibility[part] = idOf(kSelfVisibilityNames[part]);
    if (problem)
        return *problem;

    const Result<DracoMesh> draco = DracoMesh::decode(payload);
    if (!draco)
        return draco.error();
    mesh.indices = draco->indices();
    if (draco->vertexCount() != vertexCount || mesh.indices.size() != indexCount)
        return Error{
            fmt::format("Draco payload has {} vertices and {} indices, its accessors {} and {}",
                        draco->vertexCount(), mesh.indices.size(), vertexCount, indexCount)};
    const auto positions = draco->floats(position, 3);
    if (!positions)
        return positions.error();
    const auto normals = draco->floats(normal, 3);
    if (!normals)
        return normals.error();
    mesh.positions.resize(vertexCount);
    mesh.normals.resize(vertexCount);
    std::memcpy(mesh.positions.data(), positions->data(), positions->size() * sizeof(float));
    for (std::size_t i = 0; i < vertexCount;
         ++i) // a zero normal becomes NaN, which validateMesh refuses
        mesh.normals[i] =
            normalize(vec3{(*normals)[3 * i], (*normals)[3 * i + 1], (*normals)[3 * i + 2]});
    mesh.selfVisibility.resize(vertexCount);
    for (std::size_t part = 0; part < 4; ++part) {
        const auto quarter = draco->bytes(selfVisibility[part], 4);
        if (!quarter)
            return quarter.error();
        for (std::size_t i = 0; i < vertexCount; ++i)
            std::memcpy(&mesh.selfVisibility[i][4 * part], &(*quarter)[4 * i], 4);
    }
    return {};
}

Result<MeshAsset> decode(std::span<const std::byte> bytes)
{
    if (bytes.size() > kMaxMeshAssetBytes)
        return Error{fmt::format("{} bytes, more than {}", bytes.size(), kMaxMeshAssetBytes)};
    const Result<GlbView> glb = readGlb(bytes);
    if (!glb)
        return glb.error();
    const auto document = parseJson(glb->json, kMaxJsonBytes);
    if (!document)
        return document.error();

    JsonProblem problem;
    const JsonReader root(*document, "gltf", problem);
    const JsonReader source = root.member("meshes").element(0);
    if (!problem && !(source.has("extensions") && source.member("extensions").has(kFieldExtension)))
        return Error{fmt::format(
            "{} on the mesh is missing: not a compiled asset; compile it with assetc bake",
            kFieldExtension)};
    const JsonReader extension = source.member("extensions").member(kFieldExtension);
    checkVersion(extension);
    const float scale = extension.number("selfVisibilityScale", 0, 1);
    if (!problem && std::abs(scale - kSelfVisibilityScale) > 1e-6f)
        extension.refuse(fmt::format("has selfVisibilityScale {}, version 1 has {}", scale,
                                     kSelfVisibilityScale));

    MeshAsset mesh;
    mesh.name = source.has("name") ? source.text("name") : "";
    const JsonReader primitive = source.member("primitives").element(0);
    mesh.material = readMaterial(root, primitive);
    if (const auto geometry = readGeometry(root, primitive, glb->bin, problem, mesh); !geometry)
        return geometry.error();
    if (extension.has("bufferView")) {
        auto field = readField(root, extension, glb->bin, problem);
        if (!field)
            return field.error();
        mesh.field = std::move(*field);
    }
    if (problem)
        return *problem;
    if (const auto valid = validateMesh(mesh); !valid)
        return valid.error();
    updateDerived(mesh);
    return mesh;
}

} // namespace

Result<MeshAsset> decodeMeshAsset(std::span<const std::byte> bytes)
{
    try {
        return decode(bytes);
    } catch (const std::exception& exception) { // out of memory, or a library's
        return Error{fmt::format("cannot decode: {}", exception.what())};
    }
}

} // namespace penumbra
