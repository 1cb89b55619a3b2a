#include "assets/checksum.h"
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

FieldErrors readErrors(const JsonReader& errors)
{
    const auto read = [&](const char* cause) {
        const JsonReader error = errors.member(cause);
        return FieldError{error.number("rms", 0, 1e6f), error.number("max", 0, 1e6f)};
    };
    return {static_cast<std::uint32_t>(errors.count("points", 1u << 30)),
            read("total"),
            read("angular"),
            read("radial"),
            read("quantisation"),
            read("directions"),
            read("bandLimit")};
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
    if (extension.has("errors"))
        field.errors = readErrors(extension.member("errors"));
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

// Since version 1.1. Before decoding: a decoder reads sense into much that is damaged.
void checkPayload(const JsonReader& extension, const char* member,
                  std::span<const std::byte> payload)
{
    if (!extension.has(member))
        return;
    const JsonReader stated = extension.member(member);
    if (stated.asText() != checksumText(payload) && stated.isText())
        extension.refuse(fmt::format("has a {} that its data does not: the file is damaged, or "
                                     "another program rewrote it; compile it again",
                                     member));
}

std::optional<ShadowField> readField(const JsonReader& root, const JsonReader& extension,
                                     std::span<const std::byte> bin, JsonProblems& problems)
{
    const std::size_t before = problems.size();
    ShadowField field = readFieldHead(extension);
    const std::uint64_t byteLength = extension.count("byteLength", kMaxFieldBytes);
    const auto payload = readView(root, extension.count("bufferView", kMaxViews), bin);
    if (problems.size() == before)
        checkPayload(extension, "fieldChecksum", payload);
    if (problems.size() > before)
        return std::nullopt;
    if (const auto head = validateFieldHead(field); !head) {
        problems.push_back(head.error());
        return std::nullopt;
    }
    if (byteLength != fieldTexelBytes(field)) {
        extension.refuse(fmt::format("has byteLength {}, the shells need {}", byteLength,
                                     fieldTexelBytes(field)));
        return std::nullopt;
    }
    auto texels = decodeFieldTexels(field, payload);
    if (!texels) {
        problems.push_back(texels.error());
        return std::nullopt;
    }
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

// Where the geometry lies: read from the JSON, trusted by nobody.
struct GeometryHead {
    std::span<const std::byte> payload;
    std::uint64_t vertexCount = 0, indexCount = 0; // of the accessors
    std::uint32_t position = 0, normal = 0;        // Draco attribute ids
    std::array<std::uint32_t, 4> selfVisibility{};
};

GeometryHead readGeometryHead(const JsonReader& root, const JsonReader& primitive,
                              std::span<const std::byte> bin)
{
    const JsonReader compressed = primitive.member("extensions").member(kDracoExtension);
    const JsonReader ids = compressed.member("attributes");
    const auto idOf = [&](const char* name) {
        return static_cast<std::uint32_t>(ids.count(name, kMaxViews));
    };
    const auto countOf = [&](const JsonReader& accessor) {
        return root.member("accessors")
            .element(accessor.asCount(kMaxViews))
            .count("count", kMaxMeshTriangles * 3);
    };
    GeometryHead head;
    head.payload = readView(root, compressed.count("bufferView", kMaxViews), bin);
    head.vertexCount = countOf(primitive.member("attributes").member("POSITION"));
    head.indexCount = countOf(primitive.member("indices"));
    head.position = idOf("POSITION");
    head.normal = idOf("NORMAL");
    for (std::size_t part = 0; part < 4; ++part)
        head.selfVisibility[part] = idOf(kSelfVisibilityNames[part]);
    return head;
}

// Geometry out of the Draco payload, whose counts must be those of the accessors.
Result<void> readGeometry(const GeometryHead& head, MeshAsset& mesh)
{
    const Result<DracoMesh> draco =
        DracoMesh::decode(head.payload, {head.vertexCount, head.indexCount / 3});
    if (!draco)
        return draco.error();
    mesh.indices = draco->indices();
    const std::size_t vertexCount = draco->vertexCount();
    if (vertexCount != head.vertexCount || mesh.indices.size() != head.indexCount)
        return Error{
            fmt::format("Draco payload has {} vertices and {} indices, its accessors {} and {}",
                        vertexCount, mesh.indices.size(), head.vertexCount, head.indexCount)};
    const auto positions = draco->floats(head.position, 3);
    if (!positions)
        return positions.error();
    const auto normals = draco->floats(head.normal, 3);
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
        const auto quarter = draco->bytes(head.selfVisibility[part], 4);
        if (!quarter)
            return quarter.error();
        for (std::size_t i = 0; i < vertexCount; ++i)
            std::memcpy(&mesh.selfVisibility[i][4 * part], &(*quarter)[4 * i], 4);
    }
    return {};
}

void readDocument(const nlohmann::json& document, std::span<const std::byte> bin, MeshAsset& mesh,
                  JsonProblems& problems)
{
    const JsonReader root(document, "gltf", problems);
    const JsonReader source = root.member("meshes").element(0);
    if (!source.has("extensions") || !source.member("extensions").has(kFieldExtension)) {
        source.refuse(fmt::format("has no {}: not a compiled asset; compile it with assetc bake",
                                  kFieldExtension));
        return;
    }
    const JsonReader extension = source.member("extensions").member(kFieldExtension);
    checkVersion(extension);
    if (!problems.empty())
        return; // another version may mean anything by the rest
    const float scale = extension.number("selfVisibilityScale", 0, 1);
    if (std::abs(scale - kSelfVisibilityScale) > 1e-6f)
        extension.refuse(fmt::format("has selfVisibilityScale {}, version 1 has {}", scale,
                                     kSelfVisibilityScale));

    mesh.name = source.has("name") ? source.text("name") : "";
    const JsonReader primitive = source.member("primitives").element(0);
    mesh.material = readMaterial(root, primitive);
    const std::size_t before = problems.size();
    const GeometryHead head = readGeometryHead(root, primitive, bin);
    if (problems.size() == before)
        checkPayload(extension, "geometryChecksum", head.payload);
    if (problems.size() == before)
        if (const auto geometry = readGeometry(head, mesh); !geometry)
            problems.push_back(geometry.error());
    if (extension.has("bufferView"))
        mesh.field = readField(root, extension, bin, problems);
}

// An asset and no problems, or at least one problem.
std::optional<MeshAsset> decode(std::span<const std::byte> bytes, JsonProblems& problems)
{
    const auto refuse = [&](Error error) {
        problems.push_back(std::move(error));
        return std::nullopt;
    };
    try {
        if (bytes.size() > kMaxMeshAssetBytes)
            return refuse(
                {fmt::format("{} bytes, more than {}", bytes.size(), kMaxMeshAssetBytes)});
        const Result<GlbView> glb = readGlb(bytes);
        if (!glb)
            return refuse(glb.error());
        const auto document = parseJson(glb->json, kMaxJsonBytes);
        if (!document)
            return refuse(document.error());
        std::optional<MeshAsset> mesh(std::in_place);
        readDocument(*document, glb->bin, *mesh, problems);
        if (!problems.empty())
            return std::nullopt;
        if (const auto valid = validateMesh(*mesh); !valid)
            return refuse(valid.error());
        updateDerived(*mesh);
        return mesh;
    } catch (const std::exception& exception) { // out of memory, or a library's
        return refuse({fmt::format("cannot decode: {}", exception.what())});
    }
}

} // namespace

Result<MeshAsset> decodeMeshAsset(std::span<const std::byte> bytes)
{
    JsonProblems problems;
    std::optional<MeshAsset> mesh = decode(bytes, problems);
    if (!mesh)
        return problems.front();
    return std::move(*mesh);
}

std::vector<Error> checkMeshAsset(std::span<const std::byte> bytes)
{
    JsonProblems problems;
    static_cast<void>(decode(bytes, problems));
    return problems;
}

} // namespace penumbra
