#include "assetc/light.h"

#include "assetc/commands/commands.h"
#include "assetc/commands/output.h"
#include "assetc/report.h"

#include <spdlog/spdlog.h>

namespace penumbra {

int runLight(const LightArguments& arguments)
{
    if (const int code = checkOutput(arguments.input, arguments.output, ".glb"); code != kExitDone)
        return code;
    if (const int code = prepareReport(arguments.report, {arguments.input, arguments.output});
        code != kExitDone)
        return code;
    SourceFiles files;
    files.outputs = {arguments.output, arguments.report};
    const auto light = [&] {
        Progress progress(arguments.input.stem().string());
        return compileLight(arguments.input, arguments.options, progress, &files);
    }();
    if (!light) {
        logError(light.error());
        return files.overwrites ? kExitUsage : kExitInput;
    }
    for (const std::string& warning : light->asset.report.warnings)
        spdlog::warn("{}: {}", arguments.input.string(), warning);
    const std::span<const std::byte> bytes(light->asset.bytes);
    if (!writeOutput(arguments.output, bytes) ||
        !writeReport(arguments.report, lightReport(arguments.input, *light)))
        return kExitInput;
    double seconds = 0;
    for (const StageTime& time : light->asset.report.times)
        seconds += time.seconds;
    const ShadowField& field = *light->asset.mesh.field;
    fmt::print("{}: {:.4g} {:.4g} {:.4g} W, reaches {:.3g} m, {} bytes, {:.2f} s\n",
               arguments.output.string(), light->power.r, light->power.g, light->power.b,
               field.outerRadius * field.radius, bytes.size(), seconds);
    return kExitDone;
}

} // namespace penumbra
