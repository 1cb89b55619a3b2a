#include "assetc/import/import.h"

#include "assetc/file_type.h"
#include "assetc/import/gltf.h"
#include "assetc/import/gltf_scene.h"
#include "assetc/import/obj.h"
#include "runtime/file.h"

#include <algorithm>

namespace penumbra {

namespace {

std::string extensionOf(const std::filesystem::path& path)
{
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

std::string nameOf(const std::filesystem::path& path)
{
    return path.stem().string().substr(0, kMaxNameBytes);
}

Error unknownExtension(const std::string& extension)
{
    return {fmt::format("extension \"{}\" is not one of .glb, .gltf, .obj", extension)};
}

Result<ImportedMesh> meshByExtension(const std::filesystem::path& path,
                                     std::vector<AskedFile>* asked)
{
    const std::string extension = extensionOf(path);
    if (extension == ".glb" || extension == ".gltf")
        return importGltf(path, asked);
    if (extension == ".obj")
        return importObj(path, asked);
    return unknownExtension(extension);
}

Result<ImportedScene> sceneByExtension(const std::filesystem::path& path,
                                       std::vector<AskedFile>* asked)
{
    const std::string extension = extensionOf(path);
    if (extension == ".glb" || extension == ".gltf")
        return importGltfScene(path, asked);
    if (extension != ".obj")
        return unknownExtension(extension);
    auto imported = importObj(path, asked);
    if (!imported)
        return imported.error();
    ImportedScene scene;
    scene.materials = std::move(imported->mesh.materials);
    scene.images = std::move(imported->mesh.images);
    scene.warnings = std::move(imported->warnings);
    scene.meshes = {std::move(imported->mesh)};
    scene.meshes[0].name = nameOf(path);
    scene.nodes = {{nameOf(path), -1, {}, 0}};
    return scene;
}

// With the path in front. A file of another format, whatever its name says, deserves to hear which.
Error explain(const Error& error, const std::filesystem::path& path)
{
    if (const auto bytes = readFile(path, kMaxSourceBytes))
        if (const std::string other = otherKindText(*bytes, FileType::MeshSource);
            !other.empty() && !std::string_view(reinterpret_cast<const char*>(bytes->data()),
                                                bytes->size())
                                   .starts_with("glTF")) // a damaged one has a place to name
            return {fmt::format("{}: {}", path.string(), other)};
    return error.message.starts_with(path.string()) ? error : fail(error, path.string());
}

template <class Read>
auto guarded(const std::filesystem::path& path, const Read& read) -> decltype(read(path))
{
    try {
        auto imported = read(path);
        if (imported)
            return imported;
        return explain(imported.error(), path);
    } catch (
        const std::exception& exception) { // tinygltf and tinyobjloader throw on some damaged input
        return Error{fmt::format("{}: cannot be read: {}", path.string(), exception.what())};
    }
}

} // namespace

Result<ImportedMesh> importMesh(const std::filesystem::path& path, std::vector<AskedFile>* asked)
{
    auto imported = guarded(
        path, [asked](const std::filesystem::path& file) { return meshByExtension(file, asked); });
    if (imported)
        imported->mesh.name = nameOf(path);
    return imported;
}

Result<ImportedScene> importScene(const std::filesystem::path& path, std::vector<AskedFile>* asked)
{
    return guarded(
        path, [asked](const std::filesystem::path& file) { return sceneByExtension(file, asked); });
}

} // namespace penumbra
