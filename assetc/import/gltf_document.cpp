#include "assetc/import/gltf_document.h"

#include "assetc/import/gltf_check.h"
#include "assets/glb.h"
#include "assets/json_reader.h"
#include "runtime/file.h"

#include <algorithm>
#include <limits>

namespace penumbra {

namespace {

using nlohmann::json;

constexpr std::size_t kMaxJsonBytes = 256u << 20; // a .gltf may hold its buffers as base64

struct Source {
    std::filesystem::path folder;
};

bool fileExists(const std::string& name, void* source)
{
    return resolveInFolder(static_cast<Source*>(source)->folder, name).ok();
}

std::string keepPath(const std::string& name, void*)
{
    return name;
}

bool readWhole(std::vector<unsigned char>* out, std::string* error, const std::string& name,
               void* source)
{
    const auto path = resolveInFolder(static_cast<Source*>(source)->folder, name);
    const auto bytes = path ? readFile(*path, kMaxSourceBytes) : path.error();
    if (!bytes) {
        *error = bytes.error().message;
        return false;
    }
    out->resize(bytes->size());
    std::transform(bytes->begin(), bytes->end(), out->begin(),
                   [](std::byte b) { return std::to_integer<unsigned char>(b); });
    return true;
}

bool refuseWrite(std::string*, const std::string&, const std::vector<unsigned char>&, void*)
{
    return false;
}

// Extensions that change neither shape nor base colour factor may be required and ignored.
bool isSupported(const std::string& extension)
{
    for (const char* prefix : {"KHR_materials_", "KHR_texture_", "EXT_texture_",
                               "KHR_lights_punctual", "KHR_animation_"})
        if (extension.starts_with(prefix))
            return true;
    return extension == "KHR_draco_mesh_compression" || extension == "KHR_mesh_quantization" ||
           extension == "EXT_mesh_gpu_instancing" || extension == "MSFT_lod";
}

// The library reads any version as 2.0, and finds nothing in a 1.0.
Result<void> checkVersion(const json& document)
{
    const auto asset = document.find("asset");
    if (asset == document.end() || !asset->is_object())
        return {}; // its check says so
    for (const char* member : {"version", "minVersion"})
        if (const auto version = asset->find(member);
            version != asset->end() && version->is_string()) {
            const std::string text = version->get<std::string>().substr(0, 16);
            if (!text.starts_with("2.") ||
                (member == std::string_view("minVersion") && text != "2.0"))
                return Error{
                    fmt::format("asset.{} is {}; assetc reads 2.0; export it as that", member,
                                json(text).dump(-1, ' ', true, json::error_handler_t::replace))};
        }
    return {};
}

Result<void> checkExtensions(const json& document)
{
    std::string unknown;
    if (const auto required = document.find("extensionsRequired");
        required != document.end() && required->is_array())
        for (const json& name : *required)
            if (!name.is_string() || !isSupported(name.get<std::string>()))
                unknown += (unknown.empty() ? "" : ", ") +
                           name.dump(-1, ' ', true, json::error_handler_t::replace);
    if (!unknown.empty())
        return Error{"requires extensions that assetc does not read: " + unknown +
                     "; export without them"};
    return {};
}

// Indices and sizes must be whole numbers that fit an int: tinygltf takes others for absent or cuts
// them off. Recursion ends at kMaxJsonDepth.
Result<void> checkNumbers(const json& value, const std::string& place)
{
    static constexpr std::array kKeys = {
        "buffer",  "bufferView", "byteLength", "byteOffset", "byteStride", "componentType", "count",
        "indices", "material",   "mesh",       "mode",       "scene",      "skin"};
    if (!value.is_structured())
        return {};
    for (const auto& [key, member] : value.items()) {
        if (value.is_object() && (key == "extensions" || key == "extras"))
            continue; // not ours
        const std::string memberPlace = value.is_array() ? fmt::format("{}[{}]", place, key)
                                        : place.empty()  ? key
                                                         : fmt::format("{}.{}", place, key);
        const bool isWhole = member.is_number_unsigned() &&
                             member.get<std::uint64_t>() <= std::numeric_limits<int>::max();
        const bool isSparseIndices = key == "indices" && member.is_object();
        if (value.is_object() && std::find(kKeys.begin(), kKeys.end(), key) != kKeys.end() &&
            !isWhole && !isSparseIndices)
            return Error{memberPlace + " is not a whole number from 0 to 2147483647"};
        if (const auto checked = checkNumbers(member, memberPlace); !checked)
            return checked;
    }
    return {};
}

// `bytes` is what the buffer says that it has.
void checkUri(const JsonReader& reader, const std::string& uri, std::uint64_t bytes,
              const std::filesystem::path& folder, std::vector<AskedFile>* asked)
{
    std::uint64_t found = 0;
    std::string name = "the data";
    if (uri.starts_with("data:")) {
        constexpr std::string_view kBase64 = ";base64,";
        const std::size_t begin = uri.find(kBase64);
        if (begin == std::string::npos) {
            reader.refuse("is data that is not in base64; export it again");
            return;
        }
        const std::size_t last = uri.find_last_not_of('=');
        found = last < begin + kBase64.size() ? 0 : (last + 1 - begin - kBase64.size()) * 3 / 4;
    } else {
        const auto path = resolveInFolder(folder, decodeUri(uri), asked);
        const auto head = path ? readFileHead(*path, 0) : path.error();
        if (!head) {
            reader.refuse("cannot be used: " + head.error().message);
            return;
        }
        name = path->filename().string();
        found = head->fileBytes;
    }
    if (found != bytes)
        reader.refuse(fmt::format("is wrong: {} has {} bytes, and byteLength is {}; copy or export "
                                  "it again",
                                  name, found, bytes));
}

// Sizes and places of all buffers, before tinygltf allocates or opens any.
Result<void> checkBuffers(const json& document, const GlbView& view, bool binary,
                          const std::filesystem::path& folder, std::vector<AskedFile>* asked)
{
    const auto buffers = document.find("buffers");
    if (buffers == document.end())
        return {};
    if (!buffers->is_array())
        return Error{"buffers is not an array; if this is glTF 1.0, convert it to 2.0"};
    std::uint64_t sum = 0;
    std::vector<std::uint64_t> bytes; // [buffers->size()]
    JsonProblems problems;
    for (std::size_t i = 0; i < buffers->size() && problems.empty(); ++i) {
        const JsonReader buffer((*buffers)[i], fmt::format("buffers[{}]", i), problems);
        sum += bytes.emplace_back(buffer.count("byteLength", kMaxSourceBytes));
    }
    if (sum > kMaxSourceBytes)
        return Error{fmt::format("buffers of {} bytes in all, more than {}", sum, kMaxSourceBytes)};
    for (std::size_t i = 0; i < buffers->size() && problems.empty(); ++i) {
        const JsonReader buffer((*buffers)[i], fmt::format("buffers[{}]", i), problems);
        const std::string uri = buffer.has("uri") ? buffer.text("uri") : "";
        if (!problems.empty())
            break;
        if (!uri.empty())
            checkUri(buffer.member("uri"), uri, bytes[i], folder, asked);
        else if (!binary)
            buffer.refuse("has no \"uri\", and a .gltf has no data of its own; export it again");
        else if (view.bin.size() < bytes[i])
            buffer.refuse(fmt::format("has {} bytes, and the file's binary chunk {}; copy or "
                                      "export it again",
                                      bytes[i], view.bin.size()));
    }
    return problems.empty() ? Result<void>() : Result<void>(problems.front());
}

// The part that tinygltf parses. Materials are empty there, so that primitives can name them.
// Draco primitives lose `indices`: their accessor rightly has no bufferView, which tinygltf
// refuses.
json partToParse(const json& document)
{
    json part = document;
    for (const char* key :
         {"animations", "cameras", "extensions", "extras", "images", "samplers", "textures"})
        part.erase(key);
    if (const auto materials = part.find("materials");
        materials != part.end() && materials->is_array())
        *materials = json(std::vector<json>(materials->size(), json::object()));
    const auto meshes = part.find("meshes");
    if (meshes == part.end() || !meshes->is_array())
        return part;
    for (json& mesh : *meshes) {
        if (!mesh.is_object() || !mesh.contains("primitives") || !mesh["primitives"].is_array())
            continue;
        for (json& primitive : mesh["primitives"])
            if (primitive.is_object() && primitive.contains("extensions") &&
                primitive["extensions"].is_object() &&
                primitive["extensions"].contains("KHR_draco_mesh_compression"))
                primitive.erase("indices");
    }
    return part;
}

} // namespace

Result<GltfDocument> loadGltf(std::span<const std::byte> bytes, const std::filesystem::path& folder,
                              std::vector<std::string>& warnings, std::vector<AskedFile>* asked)
{
    constexpr std::array<std::byte, 4> kMagic = {std::byte{'g'}, std::byte{'l'}, std::byte{'T'},
                                                 std::byte{'F'}};
    const bool binary =
        bytes.size() >= 4 && std::equal(kMagic.begin(), kMagic.end(), bytes.begin());
    GlbView view{{reinterpret_cast<const char*>(bytes.data()), bytes.size()}, {}};
    if (binary) {
        const auto glb = readGlb(bytes);
        if (!glb)
            return glb.error();
        view = *glb;
    }
    auto document = parseJson(view.json, kMaxJsonBytes);
    if (!document)
        return document.error();
    Source source{folder};
    if (const auto version = checkVersion(*document); !version)
        return version.error();
    if (const auto extensions = checkExtensions(*document); !extensions)
        return extensions.error();
    if (const auto buffers = checkBuffers(*document, view, binary, source.folder, asked); !buffers)
        return buffers.error();
    if (document->contains("animations"))
        warnings.emplace_back("animations are not read: the rest pose is baked");
    json buffersOnly = std::move((*document)["buffers"]); // base64 may be most of the file
    document->erase("buffers");
    json parsedPart = partToParse(*document);
    if (!buffersOnly.is_null())
        parsedPart["buffers"] = std::move(buffersOnly);
    if (const auto numbers = checkNumbers(parsedPart, ""); !numbers)
        return numbers.error();
    const std::string json = parsedPart.dump(-1, ' ', false, json::error_handler_t::replace);

    tinygltf::TinyGLTF parser;
    parser.SetFsCallbacks({fileExists, keepPath, readWhole, refuseWrite, &source});
    GltfDocument out{std::move(*document), {}, source.folder, asked};
    std::string error;
    std::string ignored;
    bool parsed = false;
    if (binary) {
        const auto glb = writeGlb(json, view.bin);
        if (!glb)
            return glb.error();
        parsed = parser.LoadBinaryFromMemory(&out.model, &error, &ignored,
                                             reinterpret_cast<const unsigned char*>(glb->data()),
                                             static_cast<unsigned>(glb->size()));
    } else {
        parsed = parser.LoadASCIIFromString(&out.model, &error, &ignored, json.data(),
                                            static_cast<unsigned>(json.size()), "");
    }
    if (!parsed) {
        while (!error.empty() && error.back() == '\n')
            error.pop_back();
        return Error{fmt::format("not a readable glTF file: {}; mend it or export it again",
                                 error.substr(0, 400))};
    }
    if (const auto checked = checkModel(out.model); !checked)
        return checked.error();
    return out;
}

} // namespace penumbra
