#include "assetc/commands/output.h"

#include "assetc/commands/commands.h"
#include "assetc/file_type.h"
#include "assetc/source_files.h"
#include "assetc/words.h"
#include "runtime/file.h"

#include <spdlog/spdlog.h>

namespace penumbra {

namespace fs = std::filesystem;

namespace {

bool say(const Result<void>& done)
{
    if (!done)
        logError(done.error());
    return done.ok();
}

// Empty where `report` holds nothing or a report of ours. What it is else.
std::string whatIsLost(const fs::path& report)
{
    constexpr std::uint64_t kMaxReportBytes = 1u << 30;
    const auto bytes = readFile(report, kMaxReportBytes);
    if (!bytes)
        return "is there";
    if (bytes->empty())
        return {};
    const RecognisedFile file = recogniseFile(*bytes, report);
    return file.type == FileType::Report  ? std::string()
           : file.type == FileType::Other ? "is no report of assetc"
                                          : "is " + file.what;
}

} // namespace

int checkOutput(const fs::path& input, const fs::path& output, const char* extension)
{
    if (endingOf(output) != extension) {
        spdlog::error("{}: the output must end in {}", output.string(), extension);
        return kExitUsage;
    }
    SourceFiles files;
    files.outputs = {output};
    if (!say(files.refuseOverwrite(input)))
        return kExitUsage;
    return say(checkWritable(output)) ? kExitDone : kExitInput;
}

int prepareReport(const fs::path& report, const std::vector<fs::path>& others)
{
    if (report.empty())
        return kExitDone;
    if (endingOf(report) != ".json") {
        spdlog::error("{}: the report must end in .json", report.string());
        return kExitUsage;
    }
    std::error_code error;
    for (const fs::path& other : others)
        if (fs::weakly_canonical(report, error) == fs::weakly_canonical(other, error)) {
            spdlog::error("{}: the report would replace it; choose another name", other.string());
            return kExitUsage;
        }
    if (!say(checkWritable(report)))
        return kExitInput;
    if (!fs::exists(report, error))
        return kExitDone;
    if (const std::string lost = whatIsLost(report); !lost.empty()) {
        spdlog::error("{}: {}, and the report would replace it; choose another name",
                      report.string(), lost);
        return kExitUsage;
    }
    if (fs::file_size(report, error) > 0) // an empty one may be held for us
        fs::remove(report, error);
    return kExitDone;
}

void logError(const Error& error)
{
    for (const std::string_view line : linesOf(error.message))
        spdlog::error("{}", line);
}

bool writeOutput(const fs::path& file, std::span<const std::byte> bytes)
{
    return say(writeFile(file, bytes));
}

bool writeReport(const fs::path& file, const std::string& text)
{
    return file.empty() || say(writeFile(file, text));
}

} // namespace penumbra
