#include "assetc/import/gltf_material.h"

#include "assetc/import/folder.h"
#include "assetc/import/image_library.h"
#include "assets/material_json.h"
#include "runtime/file.h"

#include <algorithm>
#include <map>
#include <set>

namespace penumbra {

namespace {

// The bytes that an element of "images" means.
Result<std::vector<std::byte>> imageBytes(const GltfDocument& document, std::size_t index,
                                          JsonProblems& problems)
{
    const JsonReader image =
        JsonReader(document.json, "gltf", problems).member("images").element(index);
    if (image.has("bufferView")) {
        const std::uint64_t number = image.count("bufferView", kMaxGltfElements);
        if (number >= document.model.bufferViews.size()) {
            image.refuse(fmt::format("is in bufferView {}, which does not exist", number));
            return std::vector<std::byte>{};
        }
        const tinygltf::BufferView& view = document.model.bufferViews[number];
        const auto all = std::as_bytes(
            std::span(document.model.buffers[static_cast<std::size_t>(view.buffer)].data));
        const auto part = all.subspan(view.byteOffset, view.byteLength);
        if (part.size() > kMaxImageBytes)
            return Error{fmt::format("{} bytes, more than {}", part.size(), kMaxImageBytes)};
        return std::vector<std::byte>(part.begin(), part.end());
    }
    const std::string uri = image.text("uri");
    if (tinygltf::IsDataURI(uri)) {
        std::vector<unsigned char> bytes;
        std::string type;
        if (!tinygltf::DecodeDataURI(&bytes, type, uri, 0, false))
            return Error{"a data URI that is not base64"};
        const auto view = std::as_bytes(std::span(bytes));
        return std::vector<std::byte>(view.begin(), view.end());
    }
    const auto path = resolveInFolder(document.folder, decodeUri(uri), document.asked);
    return path ? readFile(*path, kMaxImageBytes) : path.error();
}

// Material extensions that are lost, for one warning.
void warnOfExtensions(const nlohmann::json& document, std::vector<std::string>& warnings)
{
    std::set<std::string> names;
    if (const auto materials = document.find("materials");
        materials != document.end() && materials->is_array())
        for (const nlohmann::json& material : *materials)
            if (const auto extensions =
                    material.is_object() ? material.find("extensions") : material.end();
                extensions != material.end() && extensions->is_object())
                for (const auto& [name, value] : extensions->items())
                    if (name.starts_with("KHR_") && name != "KHR_materials_emissive_strength")
                        names.insert(name.substr(0, 64));
    std::string list;
    for (const std::string& name : names)
        list += (list.empty() ? "" : ", ") + name;
    if (!list.empty())
        warnings.push_back("extensions of materials that are not kept: " + list);
}

} // namespace

Result<GltfMaterials> readGltfMaterials(const GltfDocument& document, const std::vector<bool>& used,
                                        std::vector<std::string>& warnings)
{
    JsonProblems problems;
    MaterialReading reading{.lenient = true};
    const JsonReader root(document.json, "gltf", problems);
    GltfMaterials out{readMaterials(root, reading, problems), {}};
    if (!problems.empty())
        return problems.front();
    warnings.insert(warnings.end(), reading.warnings.begin(), reading.warnings.end());
    warnOfExtensions(document.json, warnings);
    ImageLibrary library;
    std::map<std::uint32_t, std::optional<std::uint32_t>> places; // by index of the file
    for (std::size_t m = 0; m < out.materials.size(); ++m)
        for (std::optional<MeshTexture>& texture : out.materials[m].textures) {
            if (!texture)
                continue;
            if (!used[m]) {
                texture.reset();
                continue;
            }
            const auto [place, isNew] = places.emplace(texture->image, std::nullopt);
            if (isNew) {
                auto bytes = imageBytes(document, texture->image, problems);
                if (!problems.empty())
                    return problems.front();
                const auto added = bytes ? library.add(std::move(*bytes)) : bytes.error();
                if (added)
                    place->second = *added;
                else
                    warnings.push_back(fmt::format("images[{}]: {}; its textures are left out",
                                                   texture->image, added.error().message));
            }
            if (place->second)
                texture->image = *place->second;
            else
                texture.reset();
        }
    out.materials.push_back({});
    out.images = library.take();
    return out;
}

} // namespace penumbra
