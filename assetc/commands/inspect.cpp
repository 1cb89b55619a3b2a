#include "assetc/commands/commands.h"
#include "assetc/environment.h"
#include "assetc/report.h"
#include "assetc/source_report.h"
#include "runtime/file.h"

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace penumbra {

namespace {

struct Inspection {
    std::string what;            // the file is, empty where it cannot be read
    std::string text;            // about a valid file
    std::vector<Error> problems; // without the file's name; none: valid
};

// Messages of importers begin with the file's name, which our callers put there themselves.
Error withoutName(const Error& error, const std::filesystem::path& file)
{
    const std::string name = file.string() + ": ";
    return {error.message.starts_with(name) ? error.message.substr(name.size()) : error.message};
}

void inspectMeshAsset(std::span<const std::byte> bytes, bool json, Inspection& result)
{
    if (const auto mesh = decodeMeshAsset(bytes))
        result.text = describeAsset(*mesh, bytes.size(), json);
    else
        result.problems = checkMeshAsset(bytes); // all of them
}

void inspectEnvironment(std::span<const std::byte> bytes, bool json, Inspection& result)
{
    if (const auto environment = decodeEnvironment(bytes))
        result.text = describeEnvironment(*environment, bytes.size(), json);
    else
        result.problems.push_back(environment.error());
}

void inspectSource(const std::filesystem::path& path, const RecognisedFile& file, std::size_t bytes,
                   bool json, Inspection& result)
{
    if (file.type == FileType::MeshSource) {
        std::vector<AskedFile> asked;
        if (const auto mesh = importMesh(path, &asked))
            result.text = describeMeshSource(file, *mesh, asked, bytes, json);
        else
            result.problems.push_back(mesh.error());
    } else if (file.type == FileType::EnvironmentSource) {
        if (const auto environment = importEnvironment(path))
            result.text = describeEnvironmentSource(file, *environment, bytes, json);
        else
            result.problems.push_back(environment.error());
    } else if (const auto manifest = readManifest(path, result.problems)) {
        result.text = describeManifest(file, *manifest, bytes, json);
    }
}

Inspection inspectFile(const std::filesystem::path& path, bool json)
{
    Inspection result;
    const auto bytes = readFile(path, kMaxMeshAssetBytes);
    if (!bytes) {
        result.problems.push_back(withoutName(bytes.error(), path));
        return result;
    }
    const RecognisedFile file = recogniseFile(*bytes);
    result.what = file.what;
    switch (file.type) {
    case FileType::MeshAsset:
        inspectMeshAsset(*bytes, json, result);
        break;
    case FileType::Environment:
        inspectEnvironment(*bytes, json, result);
        break;
    case FileType::MeshSource:
    case FileType::EnvironmentSource:
    case FileType::Manifest:
        inspectSource(path, file, bytes->size(), json, result);
        break;
    case FileType::Other:
        result.problems.push_back({fileTypeText(file)});
        break;
    }
    for (Error& problem : result.problems)
        problem = withoutName(problem, path);
    return result;
}

} // namespace

int runInspect(const std::filesystem::path& file, bool json)
{
    const Inspection inspection = inspectFile(file, json);
    if (!inspection.problems.empty()) {
        spdlog::error("{}: {}", file.string(), inspection.problems.front().message);
        return kExitInput;
    }
    fmt::print("{}", inspection.text);
    return kExitDone;
}

int runValidate(const std::filesystem::path& file, bool json)
{
    const Inspection inspection = inspectFile(file, false);
    const bool valid = inspection.problems.empty();
    if (json) {
        nlohmann::ordered_json report = {
            {"file", file.string()}, {"what", inspection.what}, {"valid", valid}};
        report["problems"] = nlohmann::ordered_json::array();
        for (const Error& problem : inspection.problems)
            report["problems"].push_back(problem.message);
        fmt::print("{}\n",
                   report.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    } else if (inspection.what.empty()) { // nothing to list about a file that is not there
        spdlog::error("{}: {}", file.string(), inspection.problems.front().message);
    } else {
        for (const Error& problem : inspection.problems)
            fmt::print("{}: {}\n", file.string(), problem.message);
        fmt::print("{}: {}\n", file.string(),
                   valid ? "valid: " + inspection.what : std::string("invalid"));
    }
    return valid ? kExitDone : kExitInput;
}

} // namespace penumbra
