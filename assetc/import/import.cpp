#include "assetc/import/import.h"

#include "assetc/byte_order_mark.h"
#include "assetc/file_type.h"
#include "assetc/import/gltf.h"
#include "assetc/import/gltf_scene.h"
#include "assetc/import/obj.h"

namespace penumbra {

namespace {

std::string nameOf(const std::filesystem::path& path)
{
    return path.stem().string().substr(0, kMaxNameBytes);
}

// Binary or text, which is an object; no line of OBJ begins so.
bool isGltf(std::string_view text)
{
    const std::string_view unmarked = withoutByteOrderMark(text);
    const std::size_t begin = unmarked.find_first_not_of(" \t\r\n");
    return text.starts_with("glTF") || (begin != std::string_view::npos && unmarked[begin] == '{');
}

struct MeshSource {
    std::vector<std::byte> bytes;
    std::filesystem::path path, folder;
    std::vector<AskedFile>* asked;

    [[nodiscard]] std::string_view text() const
    {
        return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    }
};

Result<ImportedMesh> readMesh(const MeshSource& source)
{
    return isGltf(source.text()) ? importGltfBytes(source.bytes, source.folder, source.asked)
                                 : importObjText(std::string(withoutByteOrderMark(source.text())),
                                                 source.folder, source.asked);
}

Result<ImportedScene> readScene(const MeshSource& source)
{
    if (isGltf(source.text()))
        return importGltfScene(source.bytes, source.folder, source.asked);
    auto imported = readMesh(source);
    if (!imported)
        return imported.error();
    ImportedScene scene;
    scene.materials = std::move(imported->mesh.materials);
    scene.images = std::move(imported->mesh.images);
    scene.warnings = std::move(imported->warnings);
    scene.meshes = {std::move(imported->mesh)};
    scene.meshes[0].name = nameOf(source.path);
    scene.nodes = {{nameOf(source.path), -1, {}, 0}};
    return scene;
}

template <class Read>
auto guarded(const std::filesystem::path& path, std::vector<AskedFile>* asked, const Read& read)
    -> decltype(read(MeshSource{}))
{
    auto bytes = readInput(path, FileType::MeshSource, kMaxSourceBytes);
    if (!bytes)
        return bytes.error();
    try {
        auto imported = read({std::move(*bytes), path, path.parent_path(), asked});
        if (imported)
            return imported;
        return fail(imported.error(), path.string());
    } catch (
        const std::exception& exception) { // tinygltf and tinyobjloader throw on some damaged input
        return Error{fmt::format("{}: cannot be read: {}; export it again", path.string(),
                                 exception.what())};
    }
}

} // namespace

Result<ImportedMesh> importMesh(const std::filesystem::path& path, std::vector<AskedFile>* asked)
{
    auto imported = guarded(path, asked, readMesh);
    if (imported)
        imported->mesh.name = nameOf(path);
    return imported;
}

Result<ImportedScene> importScene(const std::filesystem::path& path, std::vector<AskedFile>* asked)
{
    return guarded(path, asked, readScene);
}

} // namespace penumbra
