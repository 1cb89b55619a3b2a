#include "assetc/import/import.h"

#include "assetc/import/gltf.h"
#include "assetc/import/gltf_scene.h"
#include "assetc/import/obj.h"

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

Result<ImportedMesh> meshByExtension(const std::filesystem::path& path)
{
    const std::string extension = extensionOf(path);
    if (extension == ".glb" || extension == ".gltf")
        return importGltf(path);
    if (extension == ".obj")
        return importObj(path);
    return unknownExtension(extension);
}

Result<ImportedScene> sceneByExtension(const std::filesystem::path& path)
{
    const std::string extension = extensionOf(path);
    if (extension == ".glb" || extension == ".gltf")
        return importGltfScene(path);
    if (extension != ".obj")
        return unknownExtension(extension);
    auto imported = importObj(path);
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

// What `read` gives, with the path in front of any error.
template <class Read>
auto guarded(const std::filesystem::path& path, const Read& read) -> decltype(read(path))
{
    try {
        auto imported = read(path);
        if (imported || imported.error().message.starts_with(path.string()))
            return imported;
        return fail(imported.error(), path.string());
    } catch (
        const std::exception& exception) { // tinygltf and tinyobjloader throw on some damaged input
        return Error{fmt::format("{}: cannot be read: {}", path.string(), exception.what())};
    }
}

} // namespace

Result<ImportedMesh> importMesh(const std::filesystem::path& path)
{
    auto imported = guarded(path, meshByExtension);
    if (imported)
        imported->mesh.name = nameOf(path);
    return imported;
}

Result<ImportedScene> importScene(const std::filesystem::path& path)
{
    return guarded(path, sceneByExtension);
}

} // namespace penumbra
