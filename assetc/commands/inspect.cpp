#include "assetc/commands/commands.h"
#include "assetc/inspection.h"
#include "assetc/sheet/png.h"
#include "runtime/file.h"

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace penumbra {

namespace {

bool write(const std::filesystem::path& file, const auto& content)
{
    if (const auto written = writeFile(file, content); !written) {
        spdlog::error("{}", written.error().message);
        return false;
    }
    return true;
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
    if ((!sheet.empty() && !checkOutput(file, sheet, ".png")) ||
        !checkReport(arguments.report, {file}))
        return kExitUsage;
    const Inspection inspection = inspectFile(file, !sheet.empty());
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
        if (!write(sheet, std::span<const std::byte>(encodePng(*inspection.sheet))))
            return kExitInput;
    }
    if (!arguments.report.empty() && !write(arguments.report, inspection.json))
        return kExitInput;
    fmt::print("{}", arguments.json ? inspection.json : inspection.text);
    if (!sheet.empty() && !arguments.json)
        fmt::print("picture   {}: {}\n", sheet.string(), inspection.sheetText);
    return kExitDone;
}

int runValidate(const InspectArguments& arguments)
{
    const std::filesystem::path& file = arguments.input;
    if (!checkReport(arguments.report, {file}))
        return kExitUsage;
    const Inspection inspection = inspectFile(file, false);
    const bool valid = inspection.problems.empty();
    const std::string report = validationReport(file, inspection);
    if (!arguments.report.empty() && !write(arguments.report, report))
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
