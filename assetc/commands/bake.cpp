#include "assetc/commands/commands.h"
#include "assetc/commands/output.h"
#include "assetc/report.h"
#include "assetc/words.h"

#include <spdlog/spdlog.h>

namespace penumbra {

int runBake(const BakeArguments& arguments)
{
    if (!checkOutput(arguments.input, arguments.output, ".glb") ||
        !checkReport(arguments.report, {arguments.input, arguments.output}))
        return kExitUsage;
    std::vector<AskedFile> asked;
    const auto asset = [&] {
        Progress progress(arguments.input.stem().string());
        return compileAsset(arguments.input, arguments.options, progress, &asked);
    }();
    if (!asset) {
        spdlog::error("{}", asset.error().message);
        return kExitInput;
    }
    if (!checkOverwrite(arguments.input, asked, {arguments.output, arguments.report}))
        return kExitUsage;
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
