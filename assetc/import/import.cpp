#include "assetc/import/import.h"

#include "assetc/import/gltf.h"
#include "assetc/import/obj.h"

#include <algorithm>

namespace penumbra {

namespace {

Result<ImportedMesh> importByExtension(const std::filesystem::path& path)
{
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension == ".glb" || extension == ".gltf")
        return importGltf(path);
    if (extension == ".obj")
        return importObj(path);
    return Error{fmt::format("extension \"{}\" is not one of .glb, .gltf, .obj", extension)};
}

} // namespace

Result<ImportedMesh> importMesh(const std::filesystem::path& path)
{
    try {
        Result<ImportedMesh> imported = importByExtension(path);
        if (!imported)
            return imported.error().message.starts_with(path.string())
                       ? imported.error()
                       : fail(imported.error(), path.string());
        imported->mesh.name = path.stem().string().substr(0, kMaxNameBytes);
        return imported;
    } catch (
        const std::exception& exception) { // tinygltf and tinyobjloader throw on some damaged input
        return Error{fmt::format("{}: cannot be read: {}", path.string(), exception.what())};
    }
}

} // namespace penumbra
