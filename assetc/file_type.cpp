#include "assetc/file_type.h"

#include "assetc/byte_order_mark.h"
#include "assets/glb.h"
#include "assets/json_reader.h"
#include "assets/mesh_format.h"
#include "runtime/file.h"

#include <algorithm>
#include <array>

namespace penumbra {

namespace {

constexpr std::size_t kMaxJsonBytes = 256u << 20; // a .gltf may hold its buffers as base64

constexpr const char* kBake = "compile it with assetc bake";
constexpr const char* kCompileMap = "compile it with assetc environment";
constexpr const char* kCompiled =
    "it is no source: use it as it is, or compile what it was made from";
constexpr const char* kExport = "export it as glTF (.glb), which assetc bake reads";
constexpr const char* kNotAMap =
    "assetc reads no such picture; light and sky come as OpenEXR or Radiance .hdr";

struct Signature {
    std::string_view begin;
    FileType type;
    const char* what;
    const char* remedy;
};

// Files that begin with a fixed text.
constexpr std::array kSignatures = {
    Signature{"glTF", FileType::MeshSource, "a binary glTF file", kBake},
    Signature{"PENV", FileType::Environment, "a compiled environment", kCompiled},
    Signature{"\x76\x2f\x31\x01", FileType::EnvironmentSource, "an OpenEXR picture", kCompileMap},
    Signature{"#?", FileType::EnvironmentSource, "a Radiance .hdr picture", kCompileMap},
    Signature{"\x89PNG", FileType::Other, "a PNG picture", kNotAMap},
    Signature{"\xff\xd8\xff", FileType::Other, "a JPEG picture", kNotAMap},
    Signature{"DDS ", FileType::Other, "a DirectDraw picture", kNotAMap},
    Signature{"\xabKTX", FileType::Other, "a KTX picture", kNotAMap},
    Signature{"Kaydara FBX Binary", FileType::Other, "an FBX scene", kExport},
    Signature{"BLENDER", FileType::Other, "a Blender file", kExport},
    Signature{"ply", FileType::Other, "a PLY mesh", kExport},
    Signature{"solid ", FileType::Other, "an STL mesh", kExport},
    Signature{"<?xml", FileType::Other, "an XML file", "export it as glTF (.glb) if it is a scene"},
    Signature{"PK\x03\x04", FileType::Other, "a zip archive", "unpack it"},
    Signature{"\x1f\x8b", FileType::Other, "a gzip archive", "unpack it"},
};

RecognisedFile recogniseGlb(std::span<const std::byte> bytes)
{
    const auto glb = readGlb(bytes);
    const auto document =
        glb ? parseJson(glb->json, kMaxJsonBytes) : Result<nlohmann::json>(glb.error());
    if (!document)
        return {FileType::Other, "an unreadable binary glTF file: " + document.error().message,
                "copy it again, export it as glTF 2.0 or compile it again"};
    const nlohmann::json::json_pointer extension(std::string("/meshes/0/extensions/") +
                                                 kFieldExtension);
    if (!document->contains(extension))
        return {FileType::MeshSource, "a binary glTF file", kBake};
    const nlohmann::json& field = (*document)[extension];
    const bool light = field.is_object() && field.contains("kind") && field["kind"] == "radiance";
    return {FileType::MeshAsset, light ? "a compiled light" : "a compiled mesh", kCompiled};
}

bool hasAll(const nlohmann::json& object, std::initializer_list<const char*> keys)
{
    return std::all_of(keys.begin(), keys.end(),
                       [&](const char* key) { return object.contains(key); });
}

bool isInspection(const nlohmann::json& document)
{
    constexpr std::array kTypes = {"mesh",
                                   "mesh source",
                                   "environment",
                                   "manifest",
                                   "light description",
                                   "environment source",
                                   "scene",
                                   "report"};
    return hasAll(document, {"type", "bytes"}) &&
           std::find(kTypes.begin(), kTypes.end(), document["type"]) != kTypes.end();
}

// The reports of all commands. Some have members of what they are about, but none a version.
RecognisedFile recogniseReport(const nlohmann::json& document)
{
    if (document.contains("version"))
        return {};
    constexpr const char* kRead = "it is there to be read; nothing is made of it";
    const char* what =
        hasAll(document, {"manifest", "totals"})             ? "a report of assetc build"
        : hasAll(document, {"source", "assets", "warnings"}) ? "a report of assetc bake"
        : hasAll(document, {"source", "light", "seconds"})   ? "a report of assetc light"
        : hasAll(document, {"source", "clean", "seconds"})   ? "a report of assetc bake"
        : hasAll(document, {"map", "energyShare"})           ? "a report of assetc environment"
        : hasAll(document, {"file", "valid", "problems"})    ? "a report of assetc validate"
        : isInspection(document)                             ? "a report of assetc inspect"
                                                             : nullptr;
    return what ? RecognisedFile{FileType::Report, what, kRead} : RecognisedFile{};
}

RecognisedFile recogniseJson(std::string_view text)
{
    const auto document = parseJson(text, kMaxJsonBytes);
    if (!document)
        return {FileType::Other, document.error().message, "mend it"};
    if (document->contains("asset"))
        return {FileType::MeshSource, "a glTF file", kBake};
    if (RecognisedFile report = recogniseReport(*document); report.type == FileType::Report)
        return report;
    if (document->contains("entities"))
        return {FileType::Scene, "a scene of parts", kCompiled};
    if (document->contains("assets"))
        return {FileType::Manifest, "a manifest", "build it with assetc build"};
    for (const char* key : {"type", "radiance", "power", "intensity"})
        if (document->contains(key))
            return {FileType::LightSpec, "a light description", "compile it with assetc light"};
    return {FileType::OtherJson, "JSON of another program",
            "assetc reads glTF (\"asset\"), manifests (\"assets\"), light descriptions "
            "(\"type\") and scenes (\"entities\")"};
}

// Text whose first lines are those of an OBJ file.
bool looksLikeObj(std::string_view text)
{
    constexpr std::array<std::string_view, 13> kWords = {
        "v", "vn", "vt", "vp", "f", "o", "g", "s", "l", "p", "mtllib", "usemtl", "usemap"};
    constexpr std::size_t kEnough = 100;
    std::size_t known = 0;
    for (std::size_t line = 0; line < kEnough && !text.empty(); ++line) {
        const std::string_view all = text.substr(0, text.find_first_of("\r\n"));
        text.remove_prefix(std::min(all.size() + 1, text.size()));
        const std::size_t begin = all.find_first_not_of(" \t");
        if (begin == std::string_view::npos || all[begin] == '#')
            continue;
        const std::string_view word =
            all.substr(begin, std::min(all.find_first_of(" \t", begin), all.size()) - begin);
        if (std::find(kWords.begin(), kWords.end(), word) == kWords.end())
            return false;
        ++known;
    }
    return known > 0;
}

const char* nameOf(FileType wanted)
{
    return wanted == FileType::Manifest            ? "a manifest"
           : wanted == FileType::LightSpec         ? "a light description"
           : wanted == FileType::Scene             ? "a scene"
           : wanted == FileType::EnvironmentSource ? "a map"
                                                   : "a mesh";
}

std::string_view textOf(std::span<const std::byte> bytes)
{
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

} // namespace

RecognisedFile recogniseHead(std::span<const std::byte> bytes, const std::filesystem::path& name)
{
    std::string_view text = textOf(bytes);
    if (text.empty())
        return {FileType::Other, "an empty file", "write it again"};
    for (const Signature& signature : kSignatures)
        if (text.starts_with(signature.begin))
            return {signature.type, signature.what, signature.remedy};
    text = withoutByteOrderMark(text);
    const std::size_t begin = text.find_first_not_of(" \t\r\n");
    if (begin != std::string_view::npos && (text[begin] == '{' || text[begin] == '['))
        return {FileType::OtherJson, {}, {}};
    if (looksLikeObj(text) || endingOf(name) == ".obj")
        return {FileType::MeshSource, "a Wavefront OBJ mesh", kBake};
    return {FileType::Other, "no file that assetc knows",
            "it reads meshes as glTF (.glb, .gltf) and OBJ (.obj), maps as OpenEXR (.exr) and "
            "Radiance (.hdr), manifests, light descriptions, and what it wrote itself"};
}

RecognisedFile recogniseFile(std::span<const std::byte> bytes, const std::filesystem::path& name)
{
    const std::string_view text = textOf(bytes);
    if (text.starts_with("glTF"))
        return recogniseGlb(bytes);
    RecognisedFile file = recogniseHead(bytes, name);
    return file.type == FileType::OtherJson ? recogniseJson(text) : file;
}

std::string fileTypeText(const RecognisedFile& file)
{
    return file.what + "; " + file.remedy;
}

std::string endingOf(const std::filesystem::path& name)
{
    std::string ending = name.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return ending;
}

Result<std::vector<std::byte>> readInput(const std::filesystem::path& path, FileType wanted,
                                         std::uint64_t maxBytes)
{
    auto head = readFileHead(path, maxBytes);
    if (!head)
        return head.error();
    const bool json =
        wanted == FileType::Manifest || wanted == FileType::LightSpec || wanted == FileType::Scene;
    const bool whole = head->fileBytes <= maxBytes; // else its beginning may say enough
    const RecognisedFile file =
        whole ? recogniseFile(head->bytes, path) : recogniseHead(head->bytes, path);
    const bool fits = file.type == wanted || (json && file.type == FileType::OtherJson);
    if (!fits && (whole || !file.what.empty()))
        return Error{fmt::format("{}: {}", path.string(), fileTypeText(file))};
    if (!whole)
        return Error{fmt::format("{}: {} bytes, and {} has at most {}; make it smaller, or name "
                                 "another file",
                                 path.string(), head->fileBytes, nameOf(wanted), maxBytes)};
    return std::move(head->bytes);
}

} // namespace penumbra
