#include "assetc/commands/commands.h"
#include "assetc/environment.h"
#include "assetc/report.h"
#include "assetc/sheet/contact_sheet.h"
#include "assetc/sheet/png.h"
#include "assetc/source_report.h"
#include "runtime/file.h"

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace penumbra {

namespace {

struct InspectOptions {
    bool json = false;
    bool sheet = false;
};

struct Inspection {
    std::string what;            // the file is, empty where it cannot be read
    std::string text;            // about a valid file
    std::vector<Error> problems; // without the file's name; none: valid
    std::optional<Canvas> sheet; // of a valid asset, where one was asked for
    std::string sheetText;       // what is on it
};

// Messages of importers begin with the file's name, which our callers put there themselves.
Error withoutName(const Error& error, const std::filesystem::path& file)
{
    const std::string name = file.string() + ": ";
    return {error.message.starts_with(name) ? error.message.substr(name.size()) : error.message};
}

void inspectMeshAsset(std::span<const std::byte> bytes, const InspectOptions& options,
                      Inspection& result)
{
    const auto mesh = decodeMeshAsset(bytes);
    if (!mesh) {
        result.problems = checkMeshAsset(bytes); // all of them
        return;
    }
    result.text = describeAsset(*mesh, bytes.size(), options.json);
    if (options.sheet) {
        result.sheet = drawMeshSheet(*mesh, bytes.size());
        result.sheetText = kMeshSheetText;
    }
}

void inspectEnvironment(std::span<const std::byte> bytes, const InspectOptions& options,
                        Inspection& result)
{
    const auto environment = decodeEnvironment(bytes);
    if (!environment) {
        result.problems.push_back(environment.error());
        return;
    }
    result.text = describeEnvironment(*environment, bytes.size(), options.json);
    if (options.sheet) {
        result.sheet = drawEnvironmentSheet(*environment, bytes.size());
        result.sheetText = kEnvironmentSheetText;
    }
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

Inspection inspectFile(const std::filesystem::path& path, const InspectOptions& options)
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
        inspectMeshAsset(*bytes, options, result);
        break;
    case FileType::Environment:
        inspectEnvironment(*bytes, options, result);
        break;
    case FileType::MeshSource:
    case FileType::EnvironmentSource:
    case FileType::Manifest:
        inspectSource(path, file, bytes->size(), options.json, result);
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

int runInspect(const std::filesystem::path& file, bool json, const std::filesystem::path& sheet)
{
    if (!sheet.empty() && !checkOutput(file, sheet, ".png"))
        return kExitUsage;
    const Inspection inspection = inspectFile(file, {json, !sheet.empty()});
    if (!inspection.problems.empty()) {
        spdlog::error("{}: {}", file.string(), inspection.problems.front().message);
        return kExitInput;
    }
    if (!sheet.empty()) {
        if (!inspection.sheet) {
            spdlog::error("{}: {}; --png draws compiled assets only: compile it first",
                          file.string(), inspection.what);
            return kExitInput;
        }
        if (const auto written =
                writeFile(sheet, std::span<const std::byte>(encodePng(*inspection.sheet)));
            !written) {
            spdlog::error("{}", written.error().message);
            return kExitInput;
        }
    }
    fmt::print("{}", inspection.text);
    if (!sheet.empty() && !json)
        fmt::print("picture   {}: {}\n", sheet.string(), inspection.sheetText);
    return kExitDone;
}

int runValidate(const std::filesystem::path& file, bool json)
{
    const Inspection inspection = inspectFile(file, {});
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
