#include "assetc/import/gltf_document.h"

#include "assetc/import/folder.h"
#include "assetc/import/gltf_check.h"
#include "assets/glb.h"
#include "assets/json_reader.h"
#include "runtime/file.h"

#include <algorithm>

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
    return extension == "KHR_draco_mesh_compression" || extension == "KHR_mesh_quantization";
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

// Sizes and places of all buffers, before tinygltf allocates or opens any.
Result<void> checkBuffers(const json& document, const std::filesystem::path& folder)
{
    const auto buffers = document.find("buffers");
    if (buffers == document.end())
        return {};
    if (!buffers->is_array())
        return Error{"buffers is not an array"};
    std::uint64_t sum = 0;
    JsonProblems problems;
    for (std::size_t i = 0; i < buffers->size(); ++i) {
        const JsonReader buffer((*buffers)[i], fmt::format("buffers[{}]", i), problems);
        sum += buffer.count("byteLength", kMaxSourceBytes);
        const std::string uri = buffer.has("uri") ? buffer.text("uri") : "";
        if (!uri.empty() && !uri.starts_with("data:"))
            if (const auto path = resolveInFolder(folder, decodeUri(uri)); !path)
                buffer.refuse(".uri: " + path.error().message);
        if (!problems.empty())
            return problems.front();
    }
    if (sum > kMaxSourceBytes)
        return Error{fmt::format("buffers of {} bytes in all, more than {}", sum, kMaxSourceBytes)};
    return {};
}

// Drops what is not read, so that no image is decoded and no damage there matters. Draco primitives
// lose `indices`: their accessor rightly has no bufferView, which tinygltf refuses.
void dropUnread(json& document, std::vector<std::string>& warnings)
{
    if (document.contains("animations"))
        warnings.emplace_back("animations are not read: the rest pose is baked");
    if (document.contains("textures"))
        warnings.emplace_back("textures are not read: the albedo is the base colour factor");
    for (const char* key :
         {"animations", "cameras", "extensions", "extras", "images", "samplers", "textures"})
        document.erase(key);
    const auto meshes = document.find("meshes");
    if (meshes == document.end() || !meshes->is_array())
        return;
    for (json& mesh : *meshes) {
        if (!mesh.is_object() || !mesh.contains("primitives") || !mesh["primitives"].is_array())
            continue;
        for (json& primitive : mesh["primitives"])
            if (primitive.is_object() && primitive.contains("extensions") &&
                primitive["extensions"].is_object() &&
                primitive["extensions"].contains("KHR_draco_mesh_compression"))
                primitive.erase("indices");
    }
}

} // namespace

Result<tinygltf::Model> loadGltf(const std::filesystem::path& path,
                                 std::vector<std::string>& warnings)
{
    const auto bytes = readFile(path, kMaxSourceBytes);
    if (!bytes)
        return bytes.error();
    constexpr std::array<std::byte, 4> kMagic = {std::byte{'g'}, std::byte{'l'}, std::byte{'T'},
                                                 std::byte{'F'}};
    const bool binary =
        bytes->size() >= 4 && std::equal(kMagic.begin(), kMagic.end(), bytes->begin());
    GlbView view{{reinterpret_cast<const char*>(bytes->data()), bytes->size()}, {}};
    if (binary) {
        const auto glb = readGlb(*bytes);
        if (!glb)
            return glb.error();
        view = *glb;
    }
    auto document = parseJson(view.json, kMaxJsonBytes);
    if (!document)
        return document.error();
    Source source{path.parent_path()};
    if (const auto extensions = checkExtensions(*document); !extensions)
        return extensions.error();
    if (const auto buffers = checkBuffers(*document, source.folder); !buffers)
        return buffers.error();
    dropUnread(*document, warnings);
    const std::string json = document->dump(-1, ' ', false, json::error_handler_t::replace);

    tinygltf::TinyGLTF parser;
    parser.SetFsCallbacks({fileExists, keepPath, readWhole, refuseWrite, &source});
    tinygltf::Model model;
    std::string error;
    std::string ignored;
    bool parsed = false;
    if (binary) {
        const auto glb = writeGlb(json, view.bin);
        if (!glb)
            return glb.error();
        parsed = parser.LoadBinaryFromMemory(&model, &error, &ignored,
                                             reinterpret_cast<const unsigned char*>(glb->data()),
                                             static_cast<unsigned>(glb->size()));
    } else {
        parsed = parser.LoadASCIIFromString(&model, &error, &ignored, json.data(),
                                            static_cast<unsigned>(json.size()), "");
    }
    if (!parsed) {
        while (!error.empty() && error.back() == '\n')
            error.pop_back();
        return Error{"not a readable glTF file: " + error.substr(0, 400)};
    }
    if (const auto checked = checkModel(model); !checked)
        return checked.error();
    return model;
}

} // namespace penumbra
