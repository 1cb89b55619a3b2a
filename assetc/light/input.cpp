#include "assetc/light/input.h"

#include "assetc/import/import.h"

namespace penumbra {

namespace {

Result<ImportedMesh> readMesh(const std::filesystem::path& mesh, const std::filesystem::path& light,
                              std::vector<AskedFile>* asked)
{
    std::vector<AskedFile> byMesh; // beside the mesh
    auto imported = importMesh(mesh, &byMesh);
    const auto folder =
        std::filesystem::weakly_canonical(std::filesystem::absolute(light).parent_path());
    if (asked)
        for (const AskedFile& file : byMesh) {
            const auto beside = mesh.parent_path() / file.name;
            asked->push_back({beside.lexically_relative(folder).string(), file.found});
        }
    return imported;
}

} // namespace

Result<LightInput> readLightInput(const std::filesystem::path& path, std::vector<AskedFile>* asked)
{
    auto spec = readLightSpec(path, asked);
    if (!spec)
        return spec.error();
    LightInput input{std::move(*spec), {}, {}};
    if (input.spec.shape == EmitterShape::Mesh) {
        auto mesh = readMesh(input.spec.mesh, path, asked);
        if (!mesh)
            return fail(mesh.error(), path.string() + ": light.source");
        input.mesh = std::move(*mesh);
    }
    if (!input.spec.texture.empty()) {
        auto texture = readLightPicture(input.spec.texture);
        if (!texture)
            return fail(texture.error(), path.string() + ": light.texture");
        input.texture = std::move(*texture);
    }
    return input;
}

} // namespace penumbra
