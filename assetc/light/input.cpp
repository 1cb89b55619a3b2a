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

std::optional<LightInput> readLightInput(const std::filesystem::path& path, JsonProblems& problems,
                                         std::vector<AskedFile>* asked)
{
    auto spec = readLightSpec(path, problems, asked);
    if (!spec)
        return std::nullopt;
    LightInput input{std::move(*spec), {}, {}};
    if (input.spec.shape == EmitterShape::Mesh) {
        if (auto mesh = readMesh(input.spec.mesh, path, asked))
            input.mesh = std::move(*mesh);
        else
            problems.push_back(fail(mesh.error(), path.string() + ": light.source"));
    }
    if (!input.spec.texture.empty()) {
        if (auto texture = readLightPicture(input.spec.texture))
            input.texture = std::move(*texture);
        else
            problems.push_back(fail(texture.error(), path.string() + ": light.texture"));
    }
    return problems.empty() ? std::optional(std::move(input)) : std::nullopt;
}

} // namespace penumbra
