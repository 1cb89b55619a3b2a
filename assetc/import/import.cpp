#include "assetc/import/import.h"

#include "assetc/file_type.h"
#include "assetc/import/gltf.h"
#include "assetc/import/obj.h"
#include "runtime/file.h"

#include <algorithm>

namespace penumbra {

namespace {

Result<ImportedMesh> importByExtension(const std::filesystem::path& path,
                                       std::vector<AskedFile>* asked)
{
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension == ".glb" || extension == ".gltf")
        return importGltf(path, asked);
    if (extension == ".obj")
        return importObj(path, asked);
    return Error{fmt::format("extension \"{}\" is not one of .glb, .gltf, .obj", extension)};
}

// A file of another format, whatever its name says, deserves to hear which.
Error explain(const Error& error, const std::filesystem::path& path)
{
    if (const auto bytes = readFile(path, kMaxSourceBytes))
        if (const RecognisedFile file = recogniseFile(*bytes); file.bySignature)
            return {fmt::format("{}: {}", path.string(), fileTypeText(file))};
    return error.message.starts_with(path.string()) ? error : fail(error, path.string());
}

} // namespace

Result<ImportedMesh> importMesh(const std::filesystem::path& path, std::vector<AskedFile>* asked)
{
    try {
        Result<ImportedMesh> imported = importByExtension(path, asked);
        if (!imported)
            return explain(imported.error(), path);
        imported->mesh.name = path.stem().string().substr(0, kMaxNameBytes);
        return imported;
    } catch (
        const std::exception& exception) { // tinygltf and tinyobjloader throw on some damaged input
        return Error{fmt::format("{}: cannot be read: {}", path.string(), exception.what())};
    }
}

} // namespace penumbra
