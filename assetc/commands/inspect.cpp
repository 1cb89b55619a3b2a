#include "assetc/commands/commands.h"
#include "assetc/commands/output.h"
#include "assetc/inspection.h"
#include "assetc/sheet/png.h"

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace penumbra {

namespace {

// What to draw in the place of a file that has no picture.
const char* pictureRemedy(FileType type)
{
    switch (type) {
    case FileType::MeshSource:
    case FileType::EnvironmentSource:
    case FileType::LightSpec:
        return "; compile it first";
    case FileType::Manifest:
        return "; build it and name one of its outputs";
    case FileType::Scene:
        return "; name one of its parts, which lie beside it";
    default:
        return "";
    }
}

std::string andMoreText(std::size_t more, const std::filesystem::path& file)
{
    return more == 0
               ? std::string()
               : fmt::format("; and {} more: assetc validate {} lists them", more, file.string());
}

std::string validationReport(const std::filesystem::path& file, const Inspection& inspection)
{
    nlohmann::ordered_json report = {
        {"file", file.string()}, {"what", inspection.what}, {"valid", inspection.problems.empty()}};
    report["problems"] = nlohmann::ordered_json::array();
    for (const Error& problem : inspection.problems)
        report["problems"].push_back(problem.message);
    return report.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

} // namespace

int runInspect(const InspectArguments& arguments)
{
    const std::filesystem::path &file = arguments.input, &sheet = arguments.sheet;
    if (!sheet.empty())
        if (const int code = checkOutput(file, sheet, ".png"); code != kExitDone)
            return code;
    if (const int code = prepareReport(arguments.report, {file}); code != kExitDone)
        return code;
    const Inspection inspection = inspectFile(file, !sheet.empty());
    if (!inspection.problems.empty()) {
        spdlog::error("{}: {}{}", file.string(), inspection.problems.front().message,
                      andMoreText(inspection.problems.size() - 1, file));
        return kExitInput;
    }
    if (!sheet.empty()) {
        if (!inspection.sheet) {
            spdlog::error("{}: {}; --png draws compiled meshes, lights and environments{}",
                          file.string(), inspection.what, pictureRemedy(inspection.type));
            return kExitInput;
        }
        if (!writeOutput(sheet, encodePng(*inspection.sheet)))
            return kExitInput;
    }
    if (!writeReport(arguments.report, inspection.json))
        return kExitInput;
    fmt::print("{}", arguments.json ? inspection.json : inspection.text);
    if (!sheet.empty() && !arguments.json)
        fmt::print("picture   {}: {}\n", sheet.string(), inspection.sheetText);
    return kExitDone;
}

int runValidate(const InspectArguments& arguments)
{
    const std::filesystem::path& file = arguments.input;
    if (const int code = prepareReport(arguments.report, {file}); code != kExitDone)
        return code;
    const Inspection inspection = inspectFile(file, false);
    const bool valid = inspection.problems.empty();
    const std::string report = validationReport(file, inspection);
    if (!writeReport(arguments.report, report))
        return kExitInput;
    if (arguments.json) {
        fmt::print("{}", report);
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
