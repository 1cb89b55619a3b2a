#include "assetc/commands/output.h"

#include "assetc/overwrite.h"
#include "runtime/file.h"

#include <spdlog/spdlog.h>

namespace penumbra {

namespace {

bool say(const Result<void>& done)
{
    if (!done)
        spdlog::error("{}", done.error().message);
    return done.ok();
}

} // namespace

bool checkOutput(const std::filesystem::path& input, const std::filesystem::path& output,
                 const char* extension)
{
    if (output.extension() != extension) {
        spdlog::error("{}: the output must end in {}", output.string(), extension);
        return false;
    }
    return say(refuseOverwrite(input, {}, {output}));
}

bool checkReport(const std::filesystem::path& report,
                 const std::vector<std::filesystem::path>& others)
{
    if (report.empty())
        return true;
    if (report.extension() != ".json") {
        spdlog::error("{}: the report must end in .json", report.string());
        return false;
    }
    std::error_code error;
    for (const std::filesystem::path& other : others)
        if (std::filesystem::weakly_canonical(report, error) ==
            std::filesystem::weakly_canonical(other, error)) {
            spdlog::error("{}: the report would replace it; choose another name", other.string());
            return false;
        }
    return true;
}

bool checkOverwrite(const std::filesystem::path& input, const std::vector<AskedFile>& asked,
                    const std::vector<std::filesystem::path>& outputs)
{
    return say(refuseOverwrite(input, asked, outputs));
}

bool writeOutput(const std::filesystem::path& file, std::span<const std::byte> bytes)
{
    return say(writeFile(file, bytes));
}

bool writeReport(const std::filesystem::path& file, const std::string& text)
{
    return file.empty() || say(writeFile(file, text));
}

} // namespace penumbra
