#include "assets/checksum.h"
#include "assets/field_payload.h"
#include "assets/geometry_codec.h"
#include "assets/glb.h"
#include "assets/light_json.h"
#include "assets/material_json.h"
#include "assets/mesh_codec.h"
#include "assets/mesh_format.h"

#include <algorithm>
#include <charconv>
#include <limits>

namespace penumbra {

namespace {

vec3 readVec3(const JsonReader& array)
{
    vec3 value{0};
    for (int axis = 0; axis < 3; ++axis)
        value[axis] =
            array.element(static_cast<std::size_t>(axis)).asNumber(-kMaxCoordinate, kMaxCoordinate);
    return value;
}

void checkVersion(const JsonReader& extension)
{
    if (!extension.has("version")) {
        extension.refuse("has no \"version\"; compile the asset again");
        return;
    }
    const std::string version = extension.text("version");
    int major = 0;
    const auto parsed = std::from_chars(version.data(), version.data() + version.size(), major);
    if (parsed.ec != std::errc{} || parsed.ptr == version.data() + version.size() ||
        *parsed.ptr != '.')
        extension.refuse(
            fmt::format("has version \"{}\", not MAJOR.MINOR; compile the asset again", version));
    else if (major != kFormatMajor)
        extension.refuse(fmt::format(
            "has version {}, this program reads {}.x; compile the asset again with the assetc "
            "of this version",
            version, kFormatMajor));
}

FieldErrors readErrors(const JsonReader& errors, FieldKind kind)
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
            kind == FieldKind::Occlusion ? read("bandLimit") : FieldError{}};
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
    if (extension.has("inscribedSphere")) {
        const JsonReader ball = extension.member("inscribedSphere");
        field.inscribed =
            vec4(readVec3(ball.member("center")), ball.number("radius", 0, kAnyFloat));
    }
    field.innerRadius = extension.number("innerRadius", 0, kAnyFloat);
    field.outerRadius = extension.number("outerRadius", 0, kAnyFloat);
    field.channels = static_cast<std::uint32_t>(extension.count("channels", 3));
    field.frames = static_cast<std::uint32_t>(extension.count("frames", kMaxFieldFrames));
    field.directions =
        static_cast<std::uint32_t>(extension.count("directions", kMaxFieldDirections));
    if (extension.has("errors"))
        field.errors = readErrors(extension.member("errors"), field.kind);
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

std::optional<ShadowField> readField(const JsonReader& root, const JsonReader& extension,
                                     std::span<const std::byte> bin, JsonProblems& problems)
{
    const std::size_t before = problems.size();
    ShadowField field = readFieldHead(extension);
    const std::uint64_t byteLength = extension.count("byteLength", kMaxFieldBytes);
    const auto payload = readView(root, extension.count("bufferView", kMaxGltfElements), bin);
    if (problems.size() == before)
        checkPayload(extension, "fieldChecksum", checksumText(payload));
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

// The full mesh, and since version 1.2 the meshes behind it as its LODs.
void readLevels(const JsonReader& root, const JsonReader& source, std::span<const std::byte> bin,
                MeshAsset& mesh, JsonProblems& problems)
{
    const auto materialCount = static_cast<std::uint32_t>(mesh.materials.size());
    static_cast<MeshGeometry&>(mesh) = decodePrimitives(root, source, materialCount, bin, problems);
    const JsonReader extension = source.member("extensions").member(kFieldExtension);
    const std::size_t lods =
        extension.has("lodErrors") ? extension.member("lodErrors").length(kMaxMeshLods) : 0;
    for (std::size_t i = 0; i < lods && problems.empty(); ++i) {
        MeshLod lod;
        lod.error = extension.member("lodErrors").element(i).asNumber(0, kMaxCoordinate);
        static_cast<MeshGeometry&>(lod) = decodePrimitives(
            root, root.member("meshes").element(i + 1), materialCount, bin, problems);
        mesh.lods.push_back(std::move(lod));
    }
    const auto usesDefault = [&](const MeshGeometry& geometry) {
        return std::any_of(geometry.submeshes.begin(), geometry.submeshes.end(),
                           [&](const Submesh& part) { return part.material == materialCount; });
    };
    if (usesDefault(mesh) || std::any_of(mesh.lods.begin(), mesh.lods.end(), usesDefault))
        mesh.materials.push_back({});
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
    MaterialReading strict;
    mesh.materials = readMaterials(root, strict, problems);
    readLevels(root, source, bin, mesh, problems);
    const std::size_t before = problems.size();
    mesh.images = readImages(root, bin);
    if (problems.size() == before && extension.has("imageChecksum") &&
        extension.text("imageChecksum") != imageChecksum(mesh.images))
        extension.refuse(
            "has an imageChecksum that its images do not: the file is damaged; compile it again");
    mesh.lights = readPlacedLights(root);
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
        const auto document = parseJson(glb->json, kMaxMeshJsonBytes);
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

void checkPayload(const JsonReader& extension, const char* member, const std::string& checksum)
{
    if (!extension.has(member))
        return;
    const JsonReader stated = extension.member(member);
    if (stated.asText() != checksum && stated.isText())
        extension.refuse(fmt::format("has a {} that its data does not: the file is damaged, or "
                                     "another program rewrote it; compile it again",
                                     member));
}

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
