#include "assetc/inspection.h"

#include "assetc/environment.h"
#include "assetc/light/input.h"
#include "assetc/report.h"
#include "assetc/sheet/contact_sheet.h"
#include "assetc/source_report.h"
#include "runtime/file.h"

namespace penumbra {

namespace {

template <class Describe>
void describe(Inspection& result, const Describe& say)
{
    result.text = say(false);
    result.json = say(true);
}

// Messages of importers begin with the file's name, which our callers put there themselves.
Error withoutName(const Error& error, const std::filesystem::path& file)
{
    const std::string name = file.string() + ": ";
    return {error.message.starts_with(name) ? error.message.substr(name.size()) : error.message};
}

void inspectMeshAsset(std::span<const std::byte> bytes, bool sheet, Inspection& result)
{
    const auto mesh = decodeMeshAsset(bytes);
    if (!mesh) {
        result.problems = checkMeshAsset(bytes); // all of them
        return;
    }
    describe(result, [&](bool json) { return describeAsset(*mesh, bytes.size(), json); });
    if (sheet) {
        result.sheet = drawMeshSheet(*mesh, bytes.size());
        result.sheetText = meshSheetText(*mesh);
    }
}

void inspectEnvironment(std::span<const std::byte> bytes, bool sheet, Inspection& result)
{
    const auto environment = decodeEnvironment(bytes);
    if (!environment) {
        result.problems.push_back(environment.error());
        return;
    }
    describe(result,
             [&](bool json) { return describeEnvironment(*environment, bytes.size(), json); });
    if (sheet) {
        result.sheet = drawEnvironmentSheet(*environment, bytes.size());
        result.sheetText = kEnvironmentSheetText;
    }
}

// What baking a mesh would refuse before it bakes.
void checkMesh(ImportedMesh imported, const std::string& place, Inspection& result)
{
    CompiledAsset asset;
    asset.mesh = std::move(imported.mesh);
    if (const auto prepared = prepareMesh(asset, place, {}); !prepared)
        result.problems.push_back(prepared.error());
}

void inspectSource(const std::filesystem::path& path, const RecognisedFile& file, std::size_t bytes,
                   Inspection& result)
{
    std::vector<AskedFile> asked;
    if (file.type == FileType::MeshSource) {
        if (auto mesh = importMesh(path, &asked)) {
            describe(result, [&](bool json) {
                return describeMeshSource(file, *mesh, asked, bytes, json);
            });
            checkMesh(std::move(*mesh), path.string(), result);
        } else {
            result.problems.push_back(mesh.error());
        }
    } else if (file.type == FileType::EnvironmentSource) {
        if (const auto environment = importEnvironment(path))
            describe(result, [&](bool json) {
                return describeEnvironmentSource(file, *environment, bytes, json);
            });
        else
            result.problems.push_back(environment.error());
    } else if (auto light = readLightInput(path, result.problems, &asked)) {
        describe(result, [&](bool json) {
            return describeLightSpec(file, light->spec, asked, bytes, json);
        });
        if (light->mesh)
            checkMesh(std::move(*light->mesh), path.string() + ": light.source", result);
    }
}

void inspectList(const std::filesystem::path& path, const RecognisedFile& file, std::size_t bytes,
                 Inspection& result)
{
    if (file.type == FileType::Manifest) {
        if (const auto manifest = readManifest(path, result.problems, ManifestSources::Checked))
            describe(result,
                     [&](bool json) { return describeManifest(file, *manifest, bytes, json); });
    } else if (const auto scene = readSceneFile(path, result.problems)) {
        describe(result, [&](bool json) { return describeScene(file, *scene, bytes, json); });
    }
}

} // namespace

Inspection inspectFile(const std::filesystem::path& path, bool sheet)
{
    Inspection result;
    const auto bytes = readFile(path, kMaxMeshAssetBytes);
    if (!bytes) {
        result.problems.push_back(withoutName(bytes.error(), path));
        return result;
    }
    const RecognisedFile file = recogniseFile(*bytes, path);
    result.type = file.type;
    result.what = file.what;
    switch (file.type) {
    case FileType::MeshAsset:
        inspectMeshAsset(*bytes, sheet, result);
        break;
    case FileType::Environment:
        inspectEnvironment(*bytes, sheet, result);
        break;
    case FileType::MeshSource:
    case FileType::EnvironmentSource:
    case FileType::LightSpec:
        inspectSource(path, file, bytes->size(), result);
        break;
    case FileType::Manifest:
    case FileType::Scene:
        inspectList(path, file, bytes->size(), result);
        break;
    case FileType::Report:
        describe(result, [&](bool json) { return describeReport(file, bytes->size(), json); });
        break;
    case FileType::OtherJson:
    case FileType::Other:
        result.problems.push_back({fileTypeText(file)});
        break;
    }
    for (Error& problem : result.problems)
        problem = withoutName(problem, path);
    return result;
}

} // namespace penumbra
