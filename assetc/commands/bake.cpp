#include "assetc/commands/commands.h"
#include "assetc/commands/output.h"
#include "assetc/report.h"
#include "assetc/words.h"

#include <spdlog/spdlog.h>

namespace penumbra {

int runBake(const BakeArguments& arguments)
{
    if (const int code = checkOutput(arguments.input, arguments.output, ".glb"); code != kExitDone)
        return code;
    if (const int code = prepareReport(arguments.report, {arguments.input, arguments.output});
        code != kExitDone)
        return code;
    SourceFiles files;
    files.outputs = {arguments.output, arguments.report};
    const auto asset = [&] {
        Progress progress(arguments.input.stem().string());
        return compileAsset(arguments.input, arguments.options, progress, &files);
    }();
    if (!asset) {
        logError(asset.error());
        return files.overwrites ? kExitUsage : kExitInput;
    }
    for (const std::string& warning : asset->report.warnings)
        spdlog::warn("{}: {}", arguments.input.string(), warning);
    if (!writeOutput(arguments.output, asset->bytes) ||
        !writeReport(arguments.report, compileReport(arguments.input, *asset)))
        return kExitInput;
    double seconds = 0;
    for (const StageTime& time : asset->report.times)
        seconds += time.seconds;
    fmt::print("{}{}: {} vertices, {}, {}, {} bytes, {:.2f} s\n", checksText(asset->report),
               arguments.output.string(), asset->mesh.positions.size(),
               counted(asset->mesh.indices.size() / 3, "triangle"),
               counted(asset->mesh.clusters.size(), "cluster"), asset->bytes.size(), seconds);
    return kExitDone;
}

} // namespace penumbra
